# SPDX-License-Identifier: Apache-2.0
# What `import kontur.stages` gives, for type checkers and editors. A test holds it against the module.
from collections.abc import Sequence

import numpy
from numpy.typing import ArrayLike, NDArray

from . import (
    Contour,
    ContourSet,
    Crossing,
    Disagreement,
    Grid,
    ImplicitFunction,
    Mask,
    NearLines,
    Residual,
    TriangleMesh,
    _Conflicts,
    _FillRule,
    _Kernel,
    _Normals,
    _Progress,
    _Solver,
    _Stop,
)

class Bound:
    @property
    def position(self) -> NDArray[numpy.float64]: ...
    @property
    def least_mm(self) -> float: ...
    @property
    def most_mm(self) -> float: ...
    @property
    def noise_mm(self) -> float: ...

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

class ContourOrientation:
    @property
    def normals(self) -> NDArray[numpy.float64]: ...
    @property
    def crossings(self) -> NDArray[numpy.float64]: ...

class EdgeMap:
    def __init__(self, values: ArrayLike) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def strengths(self) -> NDArray[numpy.float64]: ...
    def snap(self, pixel: tuple[int, int], radius: int) -> tuple[int, int]: ...
    def subpixel_position(self, pixel: tuple[int, int]) -> tuple[float, float]: ...

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
    def near_lines(self) -> list[NearLines]: ...

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

class LiveWire:
    def __init__(self, edges: EdgeMap, seed: tuple[int, int], reach: int = 256) -> None: ...
    @property
    def seed(self) -> tuple[int, int]: ...
    def path_to(self, target: tuple[int, int]) -> NDArray[numpy.int32]: ...

class Nesting:
    @property
    def depth(self) -> list[int]: ...
    @property
    def enclosing(self) -> list[list[int]]: ...
    @property
    def crossings(self) -> list[tuple[int, int]]: ...

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

class SelfContact:
    @property
    def kind(self) -> str: ...
    @property
    def position(self) -> NDArray[numpy.float64]: ...
    @property
    def first(self) -> int: ...
    @property
    def second(self) -> int: ...

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

class SurfaceLattice:
    @property
    def grid(self) -> Grid: ...
    @property
    def cells(self) -> NDArray[numpy.int64]: ...
    @property
    def evaluations(self) -> int: ...

def apply_fill_rule(contours: ContourSet, fill_rule: _FillRule = "even-odd") -> tuple[ContourSet, FillChanges]: ...

def disagreement(crossings: Sequence[Crossing]) -> Disagreement: ...

def disagreement_by_contour(crossings: Sequence[Crossing], contour_count: int) -> list[Disagreement]: ...

def fill(surface: SurfaceLattice, threads: int = 0) -> Mask: ...
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

def orient(contour: Contour) -> ContourOrientation: ...

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

def subdivide(contour: Contour, least_segments: int = 0) -> Contour: ...

def residual(function: ImplicitFunction, contours: ContourSet, threads: int = 0) -> Residual: ...

def sample_everywhere(
    function: ImplicitFunction,
    grid: Grid,
    threads: int = 0,
    *,
    progress: _Progress | None = None,
    stop: _Stop | None = None,
) -> SurfaceLattice: ...

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
