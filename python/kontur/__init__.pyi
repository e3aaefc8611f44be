# SPDX-License-Identifier: Apache-2.0
# What `import kontur` gives, for type checkers and editors. A test holds it against the module.
import os
import pathlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Literal, Protocol, Union, overload

import numpy
from numpy.typing import ArrayLike, NDArray

_Path = Union[str, "os.PathLike[str]"]
_Progress = Callable[[str, float], object]
_Kernel = Literal["screened", "triharmonic", "biharmonic"]
_Normals = Literal["surface", "in-plane"]
_Solver = Literal["automatic", "iterative", "cholesky", "dense"]
_Corners = Literal["rounded", "faithful"]
_UseImage = Literal["off", "auto"]
_Conflicts = Literal["reconcile", "newest-wins", "exact"]
_FillRule = Literal["even-odd", "declared"]
_Relation = Literal["exclusive", "inside", "overlap"]
_FillEnds = Literal["closed", "half", "open"]
_PlaneChoice = Literal["any", "image-slices"]
_Voxelizer = Literal["adaptive", "tracked", "exhaustive"]

class _Stop(Protocol):
    def is_set(self) -> bool: ...

__version__: str

class Error(Exception):
    kind: str

class InvalidInputError(Error, ValueError): ...

class UnsupportedError(Error, NotImplementedError): ...

class CorruptFileError(Error, ValueError): ...

class FileError(Error, OSError): ...

class SingularSystemError(Error, ArithmeticError): ...

class TooLargeError(Error, MemoryError): ...

class CancelledError(Error): ...

class Body:
    @property
    def name(self) -> str: ...
    @property
    def bounds(self) -> NDArray[numpy.float64]: ...
    def values(self, points: ArrayLike) -> NDArray[numpy.float64]: ...
    def outward_normals(self, points: ArrayLike) -> NDArray[numpy.float64]: ...

class Bound:
    @property
    def position(self) -> NDArray[numpy.float64]: ...
    @property
    def least_mm(self) -> float: ...
    @property
    def most_mm(self) -> float: ...
    @property
    def noise_mm(self) -> float: ...

class Comparison:
    @property
    def volume_a_ml(self) -> float: ...
    @property
    def volume_b_ml(self) -> float: ...
    @property
    def dice(self) -> float: ...
    @property
    def jaccard(self) -> float: ...
    @property
    def surface(self) -> SurfaceDistance | None: ...

class ConstraintSet:
    def __init__(
        self,
        centers: ArrayLike,
        values: ArrayLike,
        trust: ArrayLike | None = None,
        noise_mm: ArrayLike | None = None,
    ) -> None: ...
    @property
    def centers(self) -> NDArray[numpy.float64]: ...
    @property
    def values(self) -> NDArray[numpy.float64]: ...
    @property
    def trust(self) -> NDArray[numpy.float64]: ...
    @property
    def noise_mm(self) -> NDArray[numpy.float64]: ...
    def __len__(self) -> int: ...

class Contour:
    def __init__(
        self,
        points: ArrayLike,
        plane: Plane | None = None,
        closed: bool = True,
        hole: bool = False,
        end: Literal["automatic", "flat", "round"] = "automatic",
        inside: Literal["left", "right"] | None = None,
        weight: float = 1.0,
    ) -> None: ...
    @property
    def plane(self) -> Plane: ...
    @property
    def points(self) -> NDArray[numpy.float64]: ...
    @property
    def closed(self) -> bool: ...
    @property
    def hole(self) -> bool: ...
    @property
    def end(self) -> str: ...
    @property
    def inside(self) -> str | None: ...
    @property
    def weight(self) -> float: ...
    def __len__(self) -> int: ...
    def __eq__(self, other: object) -> bool: ...

class ContourOrientation:
    @property
    def normals(self) -> NDArray[numpy.float64]: ...
    @property
    def crossings(self) -> NDArray[numpy.float64]: ...

class CodedConcept:
    def __init__(self, value: str, scheme: str, meaning: str = "") -> None: ...
    @property
    def value(self) -> str: ...
    @property
    def scheme(self) -> str: ...
    @property
    def meaning(self) -> str: ...

class PhysicalProperty:
    def __init__(self, property: str, value: float) -> None: ...
    @property
    def value(self) -> float: ...
    @property
    def property(self) -> str: ...

class StructureAttributes:
    def __init__(
        self,
        color: tuple[int, int, int] | None = None,
        interpreted_type: str = "",
        generation_algorithm: str = "",
        description: str = "",
        number: int | None = None,
        category: CodedConcept | None = None,
        code: CodedConcept | None = None,
        physical_properties: Sequence[PhysicalProperty] = ...,
    ) -> None: ...
    @property
    def color(self) -> list[int] | None: ...
    @property
    def interpreted_type(self) -> str: ...
    @property
    def generation_algorithm(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def number(self) -> int | None: ...
    @property
    def category(self) -> CodedConcept | None: ...
    @property
    def code(self) -> CodedConcept | None: ...
    @property
    def physical_properties(self) -> list[PhysicalProperty]: ...

class ContourSet:
    def __init__(
        self,
        contours: Sequence[Contour],
        name: str = "",
        interior: ArrayLike | None = None,
        exterior: ArrayLike | None = None,
        surface: Sequence[SurfacePoint] = ...,
        empty_planes: Sequence[Plane] = ...,
        attributes: StructureAttributes | None = None,
    ) -> None: ...
    @property
    def contours(self) -> tuple[Contour, ...]: ...
    @property
    def name(self) -> str: ...
    @property
    def interior(self) -> NDArray[numpy.float64]: ...
    @property
    def exterior(self) -> NDArray[numpy.float64]: ...
    @property
    def surface(self) -> list[SurfacePoint]: ...
    @property
    def empty_planes(self) -> list[Plane]: ...
    @property
    def attributes(self) -> StructureAttributes: ...
    @property
    def point_count(self) -> int: ...
    @property
    def bounding_box(self) -> NDArray[numpy.float64]: ...
    @property
    def smallest_ball(self) -> tuple[NDArray[numpy.float64], float]: ...
    @property
    def diameter_mm(self) -> float: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Contour]: ...
    def __contains__(self, value: object) -> bool: ...
    @overload
    def __getitem__(self, index: int) -> Contour: ...
    @overload
    def __getitem__(self, index: slice) -> ContourSet: ...
    def __eq__(self, other: object) -> bool: ...

class Crossing:
    @property
    def contour(self) -> int: ...
    @property
    def other(self) -> int: ...
    @property
    def position(self) -> NDArray[numpy.float64]: ...
    @property
    def other_position(self) -> NDArray[numpy.float64]: ...
    @property
    def matched(self) -> bool: ...
    @property
    def distance_mm(self) -> float: ...
    @property
    def disagreement_mm(self) -> float: ...

class DicomGrid:
    @property
    def grid(self) -> Grid: ...
    @property
    def series(self) -> DicomSeries: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...

class DicomSegment:
    def __init__(
        self,
        number: int = 1,
        label: str = "",
        algorithm_type: str = "SEMIAUTOMATIC",
        algorithm_name: str = "",
        color: tuple[int, int, int] | None = None,
        description: str = "",
        category: CodedConcept | None = None,
        code: CodedConcept | None = None,
    ) -> None: ...
    @property
    def description(self) -> str: ...
    @property
    def category(self) -> CodedConcept | None: ...
    @property
    def code(self) -> CodedConcept | None: ...
    @property
    def number(self) -> int: ...
    @property
    def label(self) -> str: ...
    @property
    def algorithm_type(self) -> str: ...
    @property
    def algorithm_name(self) -> str: ...
    @property
    def color(self) -> list[int] | None: ...
    @property
    def voxels(self) -> int: ...
    @property
    def shared_voxels(self) -> int: ...

class DicomSegmentation:
    @property
    def grid(self) -> Grid: ...
    @property
    def segments(self) -> list[DicomSegment]: ...
    @property
    def frame_of_reference_uid(self) -> str: ...
    @property
    def referenced_series_uid(self) -> str: ...
    @property
    def notes(self) -> list[str]: ...

class DicomSeries:
    @property
    def series_uid(self) -> str: ...
    @property
    def modality(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def distinction(self) -> str: ...
    @property
    def frame_of_reference_uid(self) -> str: ...
    @property
    def files(self) -> list[pathlib.Path]: ...
    @property
    def columns(self) -> int: ...
    @property
    def rows(self) -> int: ...

class DicomVolume:
    @property
    def image(self) -> Image: ...
    @property
    def series(self) -> DicomSeries: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...

class Disagreement:
    @property
    def matched(self) -> int: ...
    @property
    def unmatched(self) -> int: ...
    @property
    def mean_mm(self) -> float: ...
    @property
    def rms_mm(self) -> float: ...
    @property
    def max_mm(self) -> float: ...
    @property
    def max_unmatched_mm(self) -> float: ...

class EdgeMap:
    def __init__(self, values: ArrayLike) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def strengths(self) -> NDArray[numpy.float64]: ...
    def snap(self, pixel: tuple[int, int], radius: int) -> tuple[int, int]: ...
    def refined(self, pixel: tuple[int, int]) -> tuple[float, float]: ...

class EditedSurface:
    @property
    def refined(self) -> bool: ...
    @property
    def function(self) -> ImplicitFunction: ...
    @property
    def mesh(self) -> TriangleMesh: ...
    @property
    def spacing_mm(self) -> float: ...
    @property
    def residual(self) -> Residual: ...
    @property
    def solves(self) -> int: ...
    @property
    def image(self) -> RefineReport: ...
    @property
    def seconds(self) -> dict[str, float]: ...

class Editor:
    def __init__(
        self,
        *,
        preview_spacing_mm: float = 0.0,
        refined_spacing_mm: float = 0.0,
        preview_points: int = 1000,
        kernel: _Kernel = "screened",
        normals: _Normals = "surface",
        normal_offset_mm: float | None = None,
        smoothing: float | None = None,
        conflicts: _Conflicts = "reconcile",
        fill_rule: _FillRule = "even-odd",
        corners: _Corners = "rounded",
        quality: float = 1.0,
        solver: _Solver = "automatic",
        tolerance_mm: float | None = None,
    ) -> None: ...
    def preview(
        self,
        contours: ContourSet,
        *,
        threads: int = 0,
        progress: _Progress | None = None,
        stop: _Stop | None = None,
    ) -> EditedSurface: ...
    def refine(
        self,
        contours: ContourSet,
        *,
        image: Image | None = None,
        threads: int = 0,
        progress: _Progress | None = None,
        stop: _Stop | None = None,
    ) -> EditedSurface: ...

class EditorUpdate:
    @property
    def kind(self) -> str: ...
    @property
    def edit(self) -> int: ...
    @property
    def surface(self) -> EditedSurface | None: ...
    @property
    def asks_image(self) -> bool: ...
    @property
    def problem(self) -> str: ...
    @property
    def stage(self) -> str: ...
    @property
    def done(self) -> float: ...

class FastFunction:
    def __init__(
        self,
        function: ImplicitFunction,
        *,
        tolerance_mm: float = 0.01,
        gradient_tolerance: float = 0.01,
        expected_points: int = 0,
    ) -> None: ...
    def values(
        self, points: ArrayLike, *, threads: int = 0, progress: _Progress | None = None, stop: _Stop | None = None
    ) -> NDArray[numpy.float64]: ...
    def gradients(
        self, points: ArrayLike, *, threads: int = 0, progress: _Progress | None = None, stop: _Stop | None = None
    ) -> NDArray[numpy.float64]: ...
    @property
    def exact(self) -> ImplicitFunction: ...
    @property
    def error_mm(self) -> float: ...
    @property
    def is_direct(self) -> bool: ...
    @property
    def kernel_values(self) -> int: ...

class FillChanges:
    @property
    def holes(self) -> int: ...
    @property
    def removed(self) -> int: ...
    @property
    def crossings(self) -> list[tuple[int, int]]: ...
    @property
    def thin_rings(self) -> list[tuple[int, int]]: ...

class ExpectedDice:
    @property
    def value(self) -> float: ...
    @property
    def low(self) -> float: ...
    @property
    def high(self) -> float: ...

class Finding:
    @property
    def kind(self) -> str: ...
    @property
    def severity(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def contour(self) -> int | None: ...
    @property
    def other(self) -> int | None: ...
    @property
    def position(self) -> NDArray[numpy.float64] | None: ...
    @property
    def value_mm(self) -> float | None: ...

class FillReport:
    @property
    def closed_voxels(self) -> int: ...
    @property
    def contested_voxels(self) -> int: ...
    @property
    def labels(self) -> list[FilledLabel]: ...
    @property
    def seconds(self) -> dict[str, float]: ...

class FilledLabel:
    @property
    def added_voxels(self) -> int: ...
    @property
    def image(self) -> RefineReport: ...
    @property
    def label(self) -> int: ...
    @property
    def painted_voxels(self) -> int: ...
    @property
    def slices(self) -> list[int]: ...
    @property
    def warnings(self) -> list[str]: ...

class FittedFunction:
    @property
    def function(self) -> ImplicitFunction: ...
    @property
    def report(self) -> SolveReport: ...
    @property
    def solves(self) -> int: ...
    @property
    def full_solves(self) -> int: ...
    @property
    def iterations(self) -> int: ...
    @property
    def merged(self) -> int: ...
    @property
    def bounded(self) -> int: ...
    @property
    def constraints(self) -> int: ...
    @property
    def tilt_change_degrees(self) -> float: ...
    @property
    def slopes(self) -> NDArray[numpy.float64]: ...

class Grid:
    def __init__(self, size: Sequence[int], index_to_mm: ArrayLike, frame: Literal["LPS", "RAS"]) -> None: ...
    @staticmethod
    def from_spacing(
        size: Sequence[int],
        spacing_mm: ArrayLike,
        origin_mm: ArrayLike = ...,
        direction: ArrayLike | None = None,
    ) -> Grid: ...
    @property
    def size(self) -> tuple[int, int, int]: ...
    @property
    def shape(self) -> tuple[int, int, int]: ...
    @property
    def index_to_mm(self) -> NDArray[numpy.float64]: ...
    def affine(self, frame: Literal["LPS", "RAS"]) -> NDArray[numpy.float64]: ...
    @property
    def spacing_mm(self) -> NDArray[numpy.float64]: ...
    @property
    def voxel_count(self) -> int: ...
    @property
    def voxel_volume_mm3(self) -> float: ...
    @property
    def bounds_mm(self) -> NDArray[numpy.float64]: ...
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...

class Image:
    def __init__(self, samples: ArrayLike, grid: Grid) -> None: ...
    @property
    def grid(self) -> Grid: ...
    @property
    def samples(self) -> NDArray[Any]: ...
    def __array__(self, dtype: Any = None) -> NDArray[Any]: ...

class ImplicitFunction:
    def __init__(
        self,
        kernel: _Kernel,
        frame_center_mm: ArrayLike,
        frame_scale_mm: float,
        centers: ArrayLike,
        weights: ArrayLike,
        polynomial: ArrayLike,
    ) -> None: ...
    @property
    def kernel(self) -> _Kernel: ...
    @property
    def frame_center_mm(self) -> NDArray[numpy.float64]: ...
    @property
    def frame_scale_mm(self) -> float: ...
    @property
    def centers(self) -> NDArray[numpy.float64]: ...
    @property
    def weights(self) -> NDArray[numpy.float64]: ...
    @property
    def polynomial(self) -> NDArray[numpy.float64]: ...
    def values(self, points: ArrayLike, threads: int = 0) -> NDArray[numpy.float64]: ...
    def __call__(self, points: ArrayLike, threads: int = 0) -> NDArray[numpy.float64]: ...
    def gradients(self, points: ArrayLike, threads: int = 0) -> NDArray[numpy.float64]: ...

class LiveEditor:
    def __init__(
        self,
        listener: Callable[[EditorUpdate], object],
        *,
        preview_spacing_mm: float = 0.0,
        refined_spacing_mm: float = 0.0,
        preview_points: int = 1000,
        kernel: _Kernel = "screened",
        normals: _Normals = "surface",
        normal_offset_mm: float | None = None,
        smoothing: float | None = None,
        conflicts: _Conflicts = "reconcile",
        fill_rule: _FillRule = "even-odd",
        corners: _Corners = "rounded",
        quality: float = 1.0,
        solver: _Solver = "automatic",
        tolerance_mm: float | None = None,
        threads: int = 0,
    ) -> None: ...
    def edit(self, contours: ContourSet, *, image: Image | None = None) -> int: ...
    def wait(self) -> None: ...
    def close(self) -> None: ...
    def __enter__(self) -> LiveEditor: ...
    def __exit__(self, *args: object) -> None: ...

class LiveWire:
    def __init__(self, edges: EdgeMap, seed: tuple[int, int], reach: int = 256) -> None: ...
    @property
    def seed(self) -> tuple[int, int]: ...
    def path_to(self, target: tuple[int, int]) -> NDArray[numpy.int32]: ...

class Mask:
    def __init__(self, values: ArrayLike, grid: Grid, label: int | None = None) -> None: ...
    @property
    def grid(self) -> Grid: ...
    @property
    def values(self) -> NDArray[numpy.uint8]: ...
    @property
    def volume_ml(self) -> float: ...
    def __array__(self, dtype: Any = None) -> NDArray[Any]: ...

class MeshTopology:
    @property
    def closed(self) -> bool: ...
    @property
    def oriented(self) -> bool: ...
    @property
    def euler(self) -> int: ...
    @property
    def components(self) -> int: ...

class Nesting:
    @property
    def depth(self) -> list[int]: ...
    @property
    def enclosing(self) -> list[list[int]]: ...
    @property
    def crossings(self) -> list[tuple[int, int]]: ...

class PhantomCase:
    @property
    def name(self) -> str: ...
    @property
    def note(self) -> str: ...
    @property
    def body(self) -> Body | None: ...
    @property
    def contours(self) -> ContourSet: ...
    @property
    def grid(self) -> Grid: ...
    @property
    def normals(self) -> list[NDArray[numpy.float64]]: ...

class PhantomVolume:
    @property
    def name(self) -> str: ...
    @property
    def note(self) -> str: ...
    @property
    def grid(self) -> Grid: ...
    @property
    def bodies(self) -> list[Body]: ...

class Plane:
    def __init__(
        self,
        origin: ArrayLike,
        normal: ArrayLike,
        u: ArrayLike | None = None,
        v: ArrayLike | None = None,
    ) -> None: ...
    @property
    def origin(self) -> NDArray[numpy.float64]: ...
    @property
    def normal(self) -> NDArray[numpy.float64]: ...
    @property
    def u(self) -> NDArray[numpy.float64]: ...
    @property
    def v(self) -> NDArray[numpy.float64]: ...
    def distance_to(self, points: ArrayLike) -> NDArray[numpy.float64]: ...
    def to_uv(self, points: ArrayLike) -> NDArray[numpy.float64]: ...
    def from_uv(self, uv: ArrayLike) -> NDArray[numpy.float64]: ...
    def __eq__(self, other: object) -> bool: ...

class PreparedContours:
    @property
    def positions(self) -> NDArray[numpy.float64]: ...
    @property
    def inplane_normals(self) -> NDArray[numpy.float64]: ...
    @property
    def plane_normals(self) -> NDArray[numpy.float64]: ...
    @property
    def contours(self) -> NDArray[numpy.int32]: ...
    @property
    def trust(self) -> NDArray[numpy.float64]: ...
    @property
    def crossings(self) -> NDArray[numpy.float64]: ...
    @property
    def bounds(self) -> list[Bound]: ...
    @property
    def ball(self) -> tuple[NDArray[numpy.float64], float]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def coplanar(self) -> bool: ...

class AskedPoint:
    @property
    def position(self) -> NDArray[numpy.float64]: ...
    @property
    def share(self) -> float: ...

class RefineReport:
    @property
    def verdict(self) -> str: ...
    @property
    def planes_left_out(self) -> int: ...
    @property
    def error_without_mm(self) -> float: ...
    @property
    def error_with_mm(self) -> float: ...
    @property
    def displaced(self) -> bool: ...
    @property
    def walked(self) -> bool: ...
    @property
    def weight(self) -> float: ...
    @property
    def wrong_without(self) -> float: ...
    @property
    def wrong_with(self) -> float: ...
    @property
    def largest_move_mm(self) -> float: ...
    @property
    def intensities(self) -> int: ...
    @property
    def on_contours_mm(self) -> float: ...
    @property
    def asked(self) -> list[AskedPoint]: ...

class Residual:
    @property
    def max_mm(self) -> float: ...
    @property
    def rms_mm(self) -> float: ...
    @property
    def worst_contour(self) -> int: ...

class Roi:
    def __init__(
        self,
        contours: ContourSet,
        name: str = "",
        color: tuple[int, int, int] | None = None,
        interpreted_type: str = "",
        generation_algorithm: str = "",
        number: int = 0,
    ) -> None: ...
    @property
    def generation_algorithm(self) -> str: ...
    @property
    def number(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def interpreted_type(self) -> str: ...
    @property
    def frame_of_reference_uid(self) -> str: ...
    @property
    def color(self) -> list[int] | None: ...
    @property
    def contours(self) -> ContourSet: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def damage(self) -> str: ...

class SegmentReport:
    @property
    def contours(self) -> int: ...
    @property
    def points(self) -> int: ...
    @property
    def constraints(self) -> int: ...
    @property
    def merged(self) -> int: ...
    @property
    def bounded(self) -> int: ...
    @property
    def centres(self) -> int: ...
    @property
    def kernel(self) -> str: ...
    @property
    def normals(self) -> str: ...
    @property
    def normal_offset_mm(self) -> float: ...
    @property
    def smoothing(self) -> float: ...
    @property
    def tolerance_mm(self) -> float: ...
    @property
    def conflicts(self) -> str: ...
    @property
    def corners(self) -> str: ...
    @property
    def fill_rule(self) -> str: ...
    @property
    def quality(self) -> float: ...
    @property
    def solver(self) -> str: ...
    @property
    def voxelizer(self) -> str: ...
    @property
    def use_image(self) -> str: ...
    @property
    def image(self) -> RefineReport: ...
    @property
    def solves(self) -> int: ...
    @property
    def iterations(self) -> int: ...
    @property
    def residual(self) -> Residual: ...
    @property
    def crossings(self) -> list[Crossing]: ...
    @property
    def evaluations(self) -> int: ...
    @property
    def surface_voxels(self) -> int: ...
    @property
    def mask_voxels(self) -> int: ...
    @property
    def mask_volume_ml(self) -> float: ...
    @property
    def mask_components(self) -> int: ...
    @property
    def uncertainty(self) -> SurfaceUncertainty: ...
    @property
    def estimated_memory_mb(self) -> float: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def seconds(self) -> dict[str, float]: ...
    def to_json(self, provenance: dict[str, str] | None = None) -> str: ...
    def to_dict(self, provenance: dict[str, str] | None = None) -> dict[str, Any]: ...

class Segmentation:
    @property
    def mask(self) -> Mask: ...
    @property
    def function(self) -> ImplicitFunction: ...
    @property
    def mesh(self) -> TriangleMesh | None: ...
    @property
    def report(self) -> SegmentReport: ...

class _SegmentationWithMesh(Segmentation):
    @property
    def mesh(self) -> TriangleMesh: ...

class SelfContact:
    @property
    def kind(self) -> str: ...
    @property
    def position(self) -> NDArray[numpy.float64]: ...
    @property
    def first(self) -> int: ...
    @property
    def second(self) -> int: ...

class SharedSurface:
    @property
    def mesh(self) -> TriangleMesh: ...
    @property
    def regions(self) -> list[list[int]]: ...
    @property
    def sides(self) -> NDArray[numpy.uint32]: ...

class Solution:
    @property
    def function(self) -> ImplicitFunction: ...
    @property
    def report(self) -> SolveReport: ...

class SolveReport:
    @property
    def solver(self) -> str: ...
    @property
    def centres(self) -> int: ...
    @property
    def iterations(self) -> int: ...
    @property
    def residual(self) -> float: ...
    @property
    def matrix_mb(self) -> float: ...

class StructurePair:
    @property
    def first(self) -> int: ...
    @property
    def second(self) -> int: ...
    @property
    def relation(self) -> str: ...
    @property
    def shared_voxels(self) -> int: ...
    @property
    def is_given(self) -> bool: ...

class StructureSet:
    def __init__(self, rois: Sequence[Roi], label: str = "") -> None: ...
    @property
    def label(self) -> str: ...
    @property
    def rois(self) -> list[Roi]: ...
    @property
    def notes(self) -> list[str]: ...

class SurfaceDistance:
    @property
    def hausdorff_mm(self) -> float: ...
    @property
    def hausdorff95_mm(self) -> float: ...
    @property
    def mean_surface_distance_mm(self) -> float: ...

class SuggestedPlane:
    @property
    def plane(self) -> Plane: ...
    @property
    def slice(self) -> tuple[int, int] | None: ...
    @property
    def gain(self) -> float: ...
    @property
    def before(self) -> ExpectedDice: ...
    @property
    def after(self) -> ExpectedDice: ...

class SurfaceLattice:
    @property
    def grid(self) -> Grid: ...
    @property
    def cells(self) -> NDArray[numpy.int64]: ...
    @property
    def evaluations(self) -> int: ...

class SurfacePoint:
    def __init__(self, position: ArrayLike, outward: ArrayLike | None = None) -> None: ...
    @property
    def position(self) -> NDArray[numpy.float64]: ...
    @property
    def outward(self) -> NDArray[numpy.float64] | None: ...
    def __eq__(self, other: object) -> bool: ...

class SurfaceUncertainty:
    @property
    def is_known(self) -> bool: ...
    @property
    def planes(self) -> int: ...
    @property
    def half_width_median_mm(self) -> float: ...
    @property
    def half_width_p90_mm(self) -> float: ...
    @property
    def farthest_mm(self) -> float: ...
    @property
    def farthest_position(self) -> NDArray[numpy.float64]: ...
    @property
    def volume_ml(self) -> float: ...
    @property
    def volume_low_ml(self) -> float: ...
    @property
    def volume_high_ml(self) -> float: ...
    @property
    def dice(self) -> ExpectedDice: ...
    @property
    def planes_to_95(self) -> int: ...
    @property
    def planes_to_98(self) -> int: ...

class Together:
    @property
    def grid(self) -> Grid: ...
    @property
    def structures(self) -> list[Segmentation]: ...
    @property
    def pairs(self) -> list[StructurePair]: ...
    @property
    def contested_voxels(self) -> int: ...
    @property
    def closed_voxels(self) -> int: ...
    @property
    def borrowed_points(self) -> int: ...
    def mask(self, structure: int) -> Mask: ...

class TriangleMesh:
    def __init__(self, points: ArrayLike, triangles: ArrayLike, normals: ArrayLike | None = None) -> None: ...
    @property
    def points(self) -> NDArray[numpy.float64]: ...
    @property
    def normals(self) -> NDArray[numpy.float64]: ...
    @property
    def triangles(self) -> NDArray[numpy.uint32]: ...

def apply_fill_rule(contours: ContourSet, fill_rule: _FillRule = "even-odd") -> tuple[ContourSet, FillChanges]: ...

def check_contour_set(
    contours: ContourSet,
    *,
    plane_tolerance_mm: float = 0.01,
    line_tolerance_mm: float = 0.002,
    disagreement_mm: float | None = None,
) -> list[Finding]: ...

def check_contours(
    contours: ContourSet,
    *,
    plane_tolerance_mm: float = 0.01,
    line_tolerance_mm: float = 0.002,
) -> None: ...

def check_contours_inside(contours: ContourSet, grid: Grid) -> str | None: ...

def compare(
    a: Mask,
    b: Mask,
    threads: int = 0,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> Comparison: ...

def component_sizes(mask: Mask) -> list[int]: ...

def contour_problems(
    contours: ContourSet,
    *,
    plane_tolerance_mm: float = 0.01,
    line_tolerance_mm: float = 0.002,
) -> list[str]: ...

def contours_sha256(contours: ContourSet) -> str: ...

def corner_distance_mm(a: Grid, b: Grid) -> float: ...

def count_labels(image: Image, max_labels: int = 4096) -> dict[int, int]: ...

def crossings(contour: Contour, plane: Plane) -> NDArray[numpy.float64]: ...

def dense_liver_case(*, points: int = 25000, orthogonal: bool = False, by_hand: bool = False) -> PhantomCase: ...

def disagreement(crossings: Sequence[Crossing]) -> Disagreement: ...

def disagreement_by_contour(crossings: Sequence[Crossing], contour_count: int) -> list[Disagreement]: ...

def encode_png(pixels: ArrayLike, provenance: dict[str, str] | None = None) -> bytes: ...

def files_sha256(
    paths: Sequence[_Path], *, progress: _Progress | None = None, stop: _Stop | None = None
) -> str: ...

def fill(surface: SurfaceLattice, threads: int = 0) -> Mask: ...

@overload
def fill_labels(
    labels: Image,
    spacing: None = None,
    *,
    image: Image | None = None,
    return_report: Literal[False] = False,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    ends: _FillEnds = "closed",
    jointly: bool = True,
    shape_weight: float = 0.5,
    use_image: _UseImage = "auto",
    smoothing_voxels: float = 0.7,
    only: Sequence[int] = [],
    threads: int = 0,
    max_memory_mb: float | None = None,
) -> Image: ...
@overload
def fill_labels(
    labels: Image,
    spacing: None = None,
    *,
    image: Image | None = None,
    return_report: Literal[True],
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    ends: _FillEnds = "closed",
    jointly: bool = True,
    shape_weight: float = 0.5,
    use_image: _UseImage = "auto",
    smoothing_voxels: float = 0.7,
    only: Sequence[int] = [],
    threads: int = 0,
    max_memory_mb: float | None = None,
) -> tuple[Image, FillReport]: ...
@overload
def fill_labels(
    labels: ArrayLike,
    spacing: Sequence[float],
    *,
    image: Image | None = None,
    return_report: Literal[False] = False,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    ends: _FillEnds = "closed",
    jointly: bool = True,
    shape_weight: float = 0.5,
    use_image: _UseImage = "auto",
    smoothing_voxels: float = 0.7,
    only: Sequence[int] = [],
    threads: int = 0,
    max_memory_mb: float | None = None,
) -> NDArray[Any]: ...
@overload
def fill_labels(
    labels: ArrayLike,
    spacing: Sequence[float],
    *,
    image: Image | None = None,
    return_report: Literal[True],
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    ends: _FillEnds = "closed",
    jointly: bool = True,
    shape_weight: float = 0.5,
    use_image: _UseImage = "auto",
    smoothing_voxels: float = 0.7,
    only: Sequence[int] = [],
    threads: int = 0,
    max_memory_mb: float | None = None,
) -> tuple[NDArray[Any], FillReport]: ...
def find_crossings(contours: ContourSet) -> list[Crossing]: ...

def find_nesting(contours: ContourSet, tolerance_mm: float) -> Nesting: ...

def find_self_contacts(points: ArrayLike) -> list[SelfContact]: ...

def fit(
    prepared: PreparedContours,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    normals: _Normals = "surface",
    rounds: int = 2,
    start_smoothing: float = 0.01,
    smoothing_factor: float = 0.3,
    least_slope: float = 0.2,
    early_tolerance_factor: float = 30.0,
    tilt_points: int = 1000,
    most_points: int = 0,
    most_solves: int = 3,
    normal_offset_mm: float = 1.0,
    both_sides: bool = False,
    normal_spacing_mm: float = 0.0,
    slope_noise: float = 0.0,
    merge_distance_mm: float = 0.0,
    kernel: _Kernel = "screened",
    ball: tuple[ArrayLike, float] | None = None,
    solver: _Solver = "automatic",
    smoothing: float = 0.0,
    tolerance_mm: float = 0.001,
    max_iterations: int = 500,
    max_memory_mb: float = 16384.0,
    threads: int = 0,
) -> FittedFunction: ...

def fit_plane(points: ArrayLike) -> Plane | None: ...

def from_nibabel(image: Any) -> Image: ...

def from_sitk(image: Any) -> Image: ...

def grid_around(box: ArrayLike, spacing_mm: ArrayLike, margin_mm: float) -> Grid: ...

def grid_sha256(grid: Grid) -> str: ...

def interpolate(image: Image, points: ArrayLike, outside: float) -> NDArray[numpy.float64]: ...

def half_widths_mm(
    segmentation: Segmentation, contours: ContourSet, points: ArrayLike, threads: int = 0
) -> NDArray[numpy.float64]: ...

def is_dicom_seg(path: _Path) -> bool: ...

def is_rtstruct(path: _Path) -> bool: ...

def list_dicom_series(folder: _Path) -> list[DicomSeries]: ...

def looks_like_dicom(path: _Path) -> bool: ...

def make_phantom_image(
    grid: Grid,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    seed: int = 1,
    noise_hu: float = 14.0,
    threads: int = 0,
) -> Image: ...

def make_picture(
    mesh: TriangleMesh,
    contours: ContourSet,
    image: Image | None = None,
    *,
    width_px: int = 1600,
    height_px: int = 1000,
    title: str = "",
    facts: Iterable[tuple[str, str]] = ...,
    window: tuple[float, float] | None = None,
    threads: int = 0,
) -> NDArray[numpy.uint8]: ...

def make_truth_mask(body: Body, grid: Grid, threads: int = 0) -> Mask: ...

def orient(contour: Contour) -> ContourOrientation: ...

def outline(mesh: TriangleMesh, plane: Plane) -> list[tuple[NDArray[numpy.float64], bool]]: ...

def phantom_bodies() -> list[Body]: ...

def phantom_case(name: str) -> PhantomCase: ...

def phantom_case_names() -> list[str]: ...

def phantom_volumes() -> list[PhantomVolume]: ...

def points_outside(contours: ContourSet, grid: Grid) -> int: ...

def polygonize(
    surface: SurfaceLattice,
    function: ImplicitFunction,
    threads: int = 0,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> TriangleMesh: ...

def prepare(
    contours: ContourSet,
    *,
    quality: float = 1.0,
    least_segments: int = 48,
    fill_rule: _FillRule = "even-odd",
    gaps: bool = True,
    click_margin_mm: float = 1.0,
    bounds: bool = True,
    copy_shift_mm: float = 0.0,
) -> PreparedContours: ...

def preview_surface(
    function: ImplicitFunction,
    starts: ArrayLike,
    spacing_mm: float = 2.0,
    threads: int = 0,
    anchor_mm: ArrayLike = (0.0, 0.0, 0.0),
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> TriangleMesh: ...

def rasterize(contours: ContourSet, grid: Grid) -> Mask: ...

def provenance(contours: ContourSet, grid: Grid, report: SegmentReport) -> dict[str, str]: ...

def read_contour_json(path: _Path) -> ContourSet: ...

def read_contours(
    path: _Path | Sequence[_Path],
    *,
    roi: str | int | None = None,
    plane_tolerance_mm: float = 0.01,
    on_note: Callable[[str], object] | None = None,
) -> ContourSet: ...

def read_dicom_grid(
    path: _Path,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    series_uid: str | None = None,
    volume: int | None = None,
    max_voxels: int = 2200000000,
) -> DicomGrid: ...

def read_dicom_seg(
    path: _Path,
    segment: int | None = None,
    max_voxels: int = 2200000000,
    *,
    on_note: Callable[[str], object] | None = None,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> Image: ...

def read_dicom_seg_masks(
    path: _Path,
    max_voxels: int = 2200000000,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> list[Mask]: ...

def read_dicom_segmentation(path: _Path, max_voxels: int = 2200000000) -> DicomSegmentation: ...

def read_dicom_series(
    path: _Path,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    series_uid: str | None = None,
    volume: int | None = None,
    max_voxels: int = 2200000000,
) -> DicomVolume: ...

def read_dicom_slice(path: _Path, frame: int = 1) -> Image: ...

def read_grid(
    path: _Path,
    *,
    on_note: Callable[[str], object] | None = None,
    frame: int | None = None,
    prefer: Literal["qform", "sform"] | None = None,
    allow_missing_geometry: bool = False,
    max_voxels: int = 2200000000,
    series_uid: str | None = None,
    volume: int | None = None,
) -> Grid: ...

def read_image(
    path: _Path,
    *,
    on_note: Callable[[str], object] | None = None,
    frame: int | None = None,
    prefer: Literal["qform", "sform"] | None = None,
    allow_missing_geometry: bool = False,
    max_voxels: int = 2200000000,
    series_uid: str | None = None,
    volume: int | None = None,
) -> Image: ...

def read_markups(path: _Path, plane_tolerance_mm: float = 0.01) -> ContourSet: ...

def read_mask(
    path: _Path,
    label: int | None = None,
    *,
    on_note: Callable[[str], object] | None = None,
    frame: int | None = None,
    prefer: Literal["qform", "sform"] | None = None,
    allow_missing_geometry: bool = False,
    max_voxels: int = 2200000000,
    series_uid: str | None = None,
    volume: int | None = None,
) -> Mask: ...

def read_mesh(path: _Path) -> TriangleMesh: ...

def read_planes_json(path: _Path) -> list[Plane]: ...

def read_provenance(path: _Path) -> dict[str, str]: ...

def read_rtstruct(path: _Path) -> StructureSet: ...

def reconcile(
    prepared: PreparedContours,
    crossings: Sequence[Crossing],
    *,
    conflicts: _Conflicts = "reconcile",
    offset_mm: float = 1.0,
    strength: float = 100.0,
    reach: float = 3.0,
) -> PreparedContours: ...

def reduce(contour: Contour, quality: float = 1.0, min_points: int = 6) -> Contour: ...

def refine(contour: Contour, least_segments: int = 0) -> Contour: ...

def residual(function: ImplicitFunction, contours: ContourSet, threads: int = 0) -> Residual: ...

def reslice(
    image: Image,
    plane: Plane,
    width: int,
    height: int,
    pixel_mm: float,
    outside: float,
) -> NDArray[numpy.float32]: ...

def sample_everywhere(
    function: ImplicitFunction,
    grid: Grid,
    threads: int = 0,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> SurfaceLattice: ...

@overload
def segment(
    contours: ContourSet,
    grid: Grid,
    *,
    image: Image | None = None,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    kernel: _Kernel = "screened",
    normals: _Normals = "surface",
    normal_offset_mm: float | None = None,
    smoothing: float | None = None,
    conflicts: _Conflicts = "reconcile",
    fill_rule: _FillRule = "even-odd",
    corners: _Corners = "rounded",
    quality: float = 1.0,
    solver: _Solver = "automatic",
    tolerance_mm: float | None = None,
    voxelizer: _Voxelizer = "adaptive",
    use_image: _UseImage = "auto",
    mesh: Literal[True],
    threads: int = 0,
    max_memory_mb: float | None = None,
) -> _SegmentationWithMesh: ...
@overload
def segment(
    contours: ContourSet,
    grid: Grid,
    *,
    image: Image | None = None,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    kernel: _Kernel = "screened",
    normals: _Normals = "surface",
    normal_offset_mm: float | None = None,
    smoothing: float | None = None,
    conflicts: _Conflicts = "reconcile",
    fill_rule: _FillRule = "even-odd",
    corners: _Corners = "rounded",
    quality: float = 1.0,
    solver: _Solver = "automatic",
    tolerance_mm: float | None = None,
    voxelizer: _Voxelizer = "adaptive",
    use_image: _UseImage = "auto",
    mesh: bool = False,
    threads: int = 0,
    max_memory_mb: float | None = None,
) -> Segmentation: ...

def segment_together(
    contours: Sequence[ContourSet],
    grid: Grid,
    *,
    image: Image | None = None,
    rules: Sequence[tuple[int | str, _Relation, int | str]] = (),
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    kernel: _Kernel = "screened",
    normals: _Normals = "surface",
    normal_offset_mm: float | None = None,
    smoothing: float | None = None,
    conflicts: _Conflicts = "reconcile",
    fill_rule: _FillRule = "even-odd",
    corners: _Corners = "rounded",
    quality: float = 1.0,
    solver: _Solver = "automatic",
    tolerance_mm: float | None = None,
    voxelizer: _Voxelizer = "adaptive",
    use_image: _UseImage = "auto",
    mesh: bool = False,
    threads: int = 0,
    max_memory_mb: float | None = None,
) -> Together: ...

def select_label(image: Image, label: float) -> Mask: ...

def select_nonzero(image: Image) -> Mask: ...

def select_roi(structures: StructureSet, name_or_number: str | int | None = None) -> Roi: ...

def shared_surface(
    together: Together,
    threads: int = 0,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> SharedSurface: ...

def signed_volume_mm3(mesh: TriangleMesh) -> float: ...

def slice_contours(
    mask: Mask,
    function: ImplicitFunction,
    threads: int = 0,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> ContourSet: ...

def solve(
    constraints: ConstraintSet,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    kernel: _Kernel = "screened",
    ball: tuple[ArrayLike, float] | None = None,
    solver: _Solver = "automatic",
    smoothing: float = 0.0,
    tolerance_mm: float = 0.001,
    max_iterations: int = 500,
    max_memory_mb: float = 16384.0,
    threads: int = 0,
) -> Solution: ...

def smooth_path(edges: EdgeMap, path: ArrayLike) -> NDArray[numpy.float64]: ...

def spline(points: ArrayLike, closed: bool, step_mm: float) -> NDArray[numpy.float64]: ...

def suggest_planes(
    segmentation: Segmentation,
    contours: ContourSet,
    count: int = 1,
    among: _PlaneChoice = "any",
    grid: Grid | None = None,
    avoid: Sequence[Plane] = (),
    threads: int = 0,
) -> list[SuggestedPlane]: ...

def suggest_window(image: Image) -> tuple[float, float]: ...

def surface_of(surface: SharedSurface, object: int) -> TriangleMesh: ...

def to_nibabel(volume: Image | Mask, image_class: Any = None) -> Any: ...

def to_sitk(volume: Image | Mask, package: Any = None) -> Any: ...

def topology(mesh: TriangleMesh) -> MeshTopology: ...

def trace(
    mask: Mask,
    planes: Sequence[Plane],
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    step_mm: float = 0.0,
    tolerance_mm: float = 1e-06,
    min_area_mm2: float = 0.0,
    threads: int = 0,
) -> ContourSet: ...

def track_surface(
    function: ImplicitFunction,
    grid: Grid,
    starts: ArrayLike,
    threads: int = 0,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> SurfaceLattice: ...

def track_surface_adaptively(
    function: ImplicitFunction,
    grid: Grid,
    starts: ArrayLike,
    threads: int = 0,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> SurfaceLattice: ...

def without_duplicate_points(contours: ContourSet) -> ContourSet: ...
def without_lines(
    contours: ContourSet,
    *,
    plane_tolerance_mm: float = 0.01,
    line_tolerance_mm: float = 0.002,
) -> ContourSet: ...

def uncertainty_map(segmentation: Segmentation, contours: ContourSet, threads: int = 0) -> Image: ...

def write_contour_json(path: _Path, contours: ContourSet, provenance: dict[str, str] | None = None) -> None: ...

def write_contours(path: _Path, contours: ContourSet, provenance: dict[str, str] | None = None) -> None: ...

def write_dicom_seg(
    path: _Path,
    labels: Image | Mask,
    segments: Sequence[DicomSegment],
    images: DicomSeries,
    *,
    on_note: Callable[[str], object] | None = None,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    provenance: dict[str, str] | None = None,
    series_description: str = "kontur segmentation",
    algorithm_name: str = "",
    algorithm_version: str = "",
    algorithm_parameters: str = "",
) -> None: ...

def write_dicom_seg_masks(
    path: _Path,
    masks: Sequence[Mask],
    segments: Sequence[DicomSegment],
    images: DicomSeries,
    *,
    on_note: Callable[[str], object] | None = None,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
    provenance: dict[str, str] | None = None,
    series_description: str = "kontur segmentation",
    algorithm_name: str = "",
    algorithm_version: str = "",
    algorithm_parameters: str = "",
) -> None: ...

def write_image(
    path: _Path,
    image: Image,
    *,
    provenance: dict[str, str] | None = None,
    label_names: dict[int, str] = ...,
    label_tags: dict[int, str] = ...,
) -> None: ...

def write_markups(path: _Path, contours: ContourSet, provenance: dict[str, str] | None = None) -> None: ...

def write_mask(
    path: _Path,
    mask: Mask,
    *,
    provenance: dict[str, str] | None = None,
    label_value: int = 1,
    segment_name: str = "Segment_1",
    segment_color: Sequence[float] = ...,
    segment_tags: str = "",
) -> None: ...

def write_mesh(path: _Path, mesh: TriangleMesh, provenance: dict[str, str] | None = None) -> None: ...

def write_png(path: _Path, pixels: ArrayLike, provenance: dict[str, str] | None = None) -> None: ...

def write_region_mesh(
    path: _Path,
    mesh: TriangleMesh,
    names: Sequence[str],
    sides: ArrayLike,
    provenance: dict[str, str] | None = None,
) -> None: ...

def write_rtstruct(
    path: _Path,
    structures: StructureSet,
    images: DicomSeries,
    *,
    on_note: Callable[[str], object] | None = None,
    provenance: dict[str, str] | None = None,
    holes: Literal["keyhole", "xor", "nested"] = "keyhole",
    series_description: str = "kontur contours",
) -> None: ...
