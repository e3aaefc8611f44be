# SPDX-License-Identifier: Apache-2.0
"""Values from Python to C++ and back."""
import copy
import gc
import inspect
import os
import pickle

import kontur
import numpy
import pytest

SANITIZED = bool(os.environ.get("KONTUR_SANITIZED"))  # ends the process where memory does not suffice
SQUARE = [[0, 0, 5], [10, 0, 5], [10, 10, 5], [0, 10, 5]]


def test_a_grid_keeps_its_affine_in_either_frame(oblique):
    ras = numpy.diag([-1, -1, 1, 1]) @ oblique.index_to_mm
    assert numpy.array_equal(oblique.affine("RAS"), ras)
    assert numpy.array_equal(oblique.affine("LPS"), oblique.index_to_mm)
    assert kontur.Grid(oblique.size, ras, frame="RAS") == oblique
    with pytest.raises(ValueError, match="'LPS' or 'RAS' is needed, not 'LAS'"):
        oblique.affine("LAS")


def test_a_grid_from_spacing_origin_and_direction(oblique):
    direction = oblique.index_to_mm[:3, :3] / oblique.spacing_mm
    grid = kontur.Grid.from_spacing(oblique.size, oblique.spacing_mm, oblique.index_to_mm[:3, 3], direction)
    assert kontur.corner_distance_mm(grid, oblique) < 1e-12


@pytest.mark.parametrize("size, affine", [((0, 1, 1), numpy.eye(4)), ((1, 1, 1), numpy.zeros((4, 4))), ((1, 1, 1), numpy.eye(3))])
def test_a_grid_that_is_none_is_refused(size, affine):
    with pytest.raises(kontur.InvalidInputError):
        kontur.Grid(size, affine, frame="LPS")


def test_a_grid_is_always_told_its_frame(oblique):
    with pytest.raises(TypeError, match="needs its frame: 'LPS' .* or 'RAS' .*nibabel"):
        kontur.Grid(oblique.size, oblique.index_to_mm)
    with pytest.raises(TypeError, match="needs its frame"):
        kontur.Grid(size=oblique.size, index_to_mm=oblique.index_to_mm)
    frame = inspect.signature(kontur.Grid.__init__).parameters["frame"]
    assert frame.default is inspect.Parameter.empty


def test_equal_grids_are_one_key(oblique):
    zero = numpy.diag([1.0, 1, 1, 1])
    minus_zero = zero.copy()
    minus_zero[0, 3] = -0.0
    grids = [oblique, pickle.loads(pickle.dumps(oblique)), kontur.Grid((5, 4, 3), zero, "LPS"), kontur.Grid((5, 4, 3), minus_zero, "LPS"),
             kontur.Grid((5, 4, 2), zero, "LPS"), kontur.Grid((5, 4, 3), zero, "RAS")]
    assert grids[0] == grids[1] and grids[2] == grids[3]
    assert len({grid: None for grid in grids}) == 4 == len({hash(grid) for grid in grids})


def test_a_contour_finds_its_plane_and_does_not_change():
    contour = kontur.Contour(SQUARE, hole=True)
    assert contour.points.tolist() == SQUARE
    assert (contour.closed, contour.hole, len(contour), contour.weight) == (True, True, 4, 1)
    assert kontur.Contour(SQUARE, weight=2) != kontur.Contour(SQUARE)
    assert abs(contour.plane.distance_to(SQUARE)).max() < 1e-12
    with pytest.raises(ValueError):
        contour.points[0] = 1
    with pytest.raises(AttributeError):
        contour.hole = False
    with pytest.raises(kontur.InvalidInputError, match="2 points spans no plane"):
        kontur.Contour(SQUARE[:2])


@pytest.mark.parametrize("wrong", [numpy.nan, numpy.inf, -numpy.inf])
def test_a_contour_that_is_not_finite_says_so(wrong):
    points = [*SQUARE[:2], [wrong, 10, 5], SQUARE[3]]
    for plane in (None, kontur.Plane([0, 0, 5], [0, 0, 1])):
        with pytest.raises(kontur.InvalidInputError, match=f"point 3 of a contour is not finite: .{wrong}, 10.0, 5.0"):
            kontur.Contour(points, plane)


def test_arrays_of_a_wrong_shape_are_refused():
    for points in ([[0, 0], [1, 0], [0, 1]], numpy.zeros((2, 3, 1)), [1, 2, 3]):
        with pytest.raises(kontur.InvalidInputError, match=r"\(n, 3\) is needed"):
            kontur.Contour(points)
    with pytest.raises(ValueError, match=r"\(3,\) is needed"):
        kontur.Plane([0, 0], [0, 0, 1])


def test_a_plane_with_given_axes_must_be_orthonormal():
    plane = kontur.Plane([1, 2, 3], [0, 0, 1], u=[0, 1, 0], v=[-1, 0, 0])
    assert plane.to_uv([[1, 4, 9]]).tolist() == [[2, 0]]
    with pytest.raises(kontur.InvalidInputError, match="not orthonormal"):
        kontur.Plane([1, 2, 3], [0, 0, 1], u=[0, 1, 0], v=[-1, 0.1, 0])
    with pytest.raises(kontur.InvalidInputError, match="normal that is not 0"):
        kontur.Plane([1, 2, 3], [0, 0, 0])


def test_the_contours_of_a_set_live_as_long_as_someone_holds_them():
    points = kontur.ContourSet([kontur.Contour(SQUARE)], name="square").contours[0].points
    gc.collect()
    assert points.tolist() == SQUARE


def test_a_set_is_a_sequence_of_its_contours(case):
    contours = case.contours
    assert list(contours) == list(contours.contours) == [contours[n] for n in range(len(contours))]
    assert contours[-1] == contours[len(contours) - 1] == contours.contours[-1] == next(reversed(contours))
    assert all(contour in contours for contour in contours)
    assert kontur.Contour(SQUARE) not in contours and "kidney" not in contours
    for index in (6, -7, 2**40):
        with pytest.raises(IndexError, match=f"no contour {index}; the set has 6"):
            contours[index]
    with pytest.raises(TypeError):
        contours["kidney"]
    points = contours[0].points
    gc.collect()
    assert points.shape == (244, 3)
    assert list(kontur.ContourSet([])) == [] and not kontur.ContourSet([])


def test_a_slice_of_a_set_is_a_set(case):
    whole = kontur.ContourSet(case.contours, name="kidney", interior=[[1, 2, 3]], exterior=[[4, 5, 6]],
                              surface=[kontur.SurfacePoint([7, 8, 9])], empty_planes=[kontur.Plane([0, 0, 90], [0, 0, 1])])
    assert len(whole) == 6 and whole[:] == whole
    for some in (slice(1, 4), slice(None, None, 2), slice(None, None, -1), slice(4, 1), slice(-2, 100)):
        part = whole[some]
        assert isinstance(part, kontur.ContourSet) and list(part) == list(whole)[some]
        assert (part.name, part.interior.tolist(), part.exterior.tolist()) == ("kidney", [[1, 2, 3]], [[4, 5, 6]])
        assert part.surface == whole.surface and part.empty_planes == whole.empty_planes
    assert pickle.loads(pickle.dumps(whole)) == whole != kontur.ContourSet(whole.contours, whole.name)
    with pytest.raises(ValueError):
        whole[::0]


def test_a_masks_array_is_its_memory(oblique):
    inside = numpy.zeros(oblique.shape, bool)
    inside[2, 3, 4] = True
    mask = kontur.Mask(inside, oblique)
    values = mask.values
    assert (values.shape, values.dtype, values.flags.c_contiguous) == ((3, 4, 5), numpy.uint8, True)
    assert values.ravel().nonzero()[0].tolist() == [59]
    assert numpy.shares_memory(values, mask.values)
    values[0, 0, 0] = 1
    del mask
    gc.collect()
    assert values.sum() == 2


def test_the_masks_array_outlives_the_segmentation(case):
    values = kontur.segment(case.contours, case.grid).mask.values
    gc.collect()
    assert values.sum() > 1000


def test_what_is_not_zero_is_inside(oblique):
    inside = (numpy.arange(60) % 7 == 0).reshape(oblique.shape)
    for array in (inside, inside.astype("u1") * 255, inside.astype("i8") * 70_000, inside.astype(">i2"), inside.astype("f4"), inside * 3.0,
                  numpy.asfortranarray(inside), inside[:, ::-1], inside.tolist(), inside & False, inside | True):
        assert numpy.array_equal(kontur.Mask(array, oblique).values, numpy.asarray(array) != 0)
    with pytest.raises(kontur.InvalidInputError, match=r"\(5, 4, 3\); the grid's \(z, y, x\) is \(3, 4, 5\)"):
        kontur.Mask(inside.T, oblique)


def test_a_mask_of_a_label_map_is_told_the_label(oblique):
    labels = (numpy.arange(60) % 4 - 1).reshape(oblique.shape)
    for array in (labels, labels.astype("i2"), labels.astype("f8"), labels.astype("f4")):
        for label in (1, 2, -1, numpy.int64(2)):
            assert numpy.array_equal(kontur.Mask(array, oblique, label=label).values, labels == label)
        with pytest.raises(kontur.InvalidInputError, match="the array has no label 7; its labels are -1, 1, 2"):
            kontur.Mask(array, oblique, label=7)
    big = labels * 2**24 + (labels > 0)
    assert numpy.array_equal(kontur.Mask(big.astype("f8"), oblique, label=2**24 + 1).values, labels == 1)
    with pytest.raises(TypeError):
        kontur.Mask(labels, oblique, label=1.5)


def test_a_mask_refuses_what_read_mask_refuses(tmp_path, oblique):
    """And what is no mask in the first place: the arrays that other programs hand over as one."""
    def refused(values, sentence, dtype="f8"):
        array = numpy.resize(numpy.array(values, dtype), oblique.shape)
        with pytest.raises(kontur.InvalidInputError, match=sentence) as mine:
            kontur.Mask(array, oblique)
        return array, str(mine.value)

    def refused_as_file(values, sentence, dtype):
        array, mine = refused(values, sentence, dtype)
        kontur.write_image(tmp_path / "a.nrrd", kontur.Image(array, oblique))
        with pytest.raises(kontur.InvalidInputError) as files:
            kontur.read_mask(tmp_path / "a.nrrd")
        return mine, str(files.value).replace(str(tmp_path / "a.nrrd"), "the array")

    mine, files = refused_as_file([0, 1, 2], "the array has 2 labels; choose one of 1, 2 with the option label", "u1")
    assert mine == files
    mine, files = refused_as_file(numpy.arange(60), "has 59 labels; choose one of 1, .* and 39 more", "i4")
    assert mine == files
    _, files = refused_as_file([0, 0.25, 1], "20 voxels hold values that are not integers, the first is 0.25", "f4")
    assert "20 voxels hold values that are not integers" in files
    refused([0, 1, 1 + 1e-9], "20 voxels hold values that are not integers, the first is 1.000000001")
    refused([0, 1, numpy.nan], "not integers, the first is nan")
    refused([0, 1, numpy.inf], "not integers, the first is inf")
    for dtype in ("i1", "i8", "f4"):
        refused([0, -1], "the array has the value -1; a mask holds 0 and one value above it, or choose one", dtype)
    values = numpy.resize([0, -1], oblique.shape)
    assert numpy.array_equal(kontur.Mask(values, oblique, label=-1).values, values != 0)


def test_an_array_with_masked_entries_is_refused(oblique):
    entries = numpy.zeros(oblique.shape, "i2")
    whole = numpy.ma.masked_array(entries, mask=numpy.zeros(oblique.shape, bool))
    assert kontur.Image(whole, oblique).samples.dtype == "int16" and kontur.Mask(whole, oblique).volume_ml == 0
    holes = numpy.ma.masked_array(entries, mask=numpy.arange(60).reshape(oblique.shape) < 7)
    square = numpy.ma.masked_equal(SQUARE, 10)
    calls = [
        (7, lambda: kontur.Image(holes, oblique)),
        (7, lambda: kontur.Mask(holes, oblique)),
        (7, lambda: kontur.Mask(holes != 0, oblique)),
        (7, lambda: kontur.fill_labels(holes, (1, 1, 1))),
        (4, lambda: kontur.Contour(square)),
        (1, lambda: kontur.Contour(list(square))),
        (4, lambda: kontur.ContourSet([], interior=square)),
        (1, lambda: kontur.Plane(square[1], [0, 0, 1])),
        (1, lambda: kontur.Plane([0, 0, numpy.ma.masked], [0, 0, 1])),
        (4, lambda: kontur.TriangleMesh(square, [])),
        (2, lambda: kontur.stages.ConstraintSet(numpy.eye(3), numpy.ma.masked_equal([0, 1, 0], 0))),
        (2, lambda: kontur.stages.ConstraintSet(numpy.eye(3), numpy.ones(3), trust=numpy.ma.masked_equal([0, 1, 0], 0))),
        (3, lambda: kontur.ImplicitFunction("biharmonic", [0, 0, 0], 1, numpy.eye(3), numpy.ma.masked_equal(numpy.ones(3), 1), [1, 0, 0, 0])),
        (3, lambda: kontur.ImplicitFunction("biharmonic", [0, 0, 0], 1, numpy.eye(3), numpy.ones(3), numpy.ma.masked_equal([1, 0, 0, 0], 0))),
        (1, lambda: kontur.Grid.from_spacing((1, 1, 1), numpy.ma.masked_equal([1, 2, 3], 2))),
        (12, lambda: kontur.Grid((1, 1, 1), numpy.ma.masked_equal(numpy.eye(4), 0), frame="LPS")),
        (9, lambda: kontur.stages.EdgeMap(numpy.ma.masked_equal(numpy.ones((3, 3)), 1))),
        (1, lambda: kontur.encode_png(numpy.ma.masked_equal(numpy.arange(12).reshape(2, 2, 3), 5))),
    ]
    for count, call in calls:
        with pytest.raises(kontur.InvalidInputError, match=f"an array is masked at {count} of its") as error:
            call()
        assert "filled" in str(error.value)


def test_a_function_of_parts_that_do_not_fit_is_refused():
    for weights, polynomial, problem in ((numpy.ones((3, 1)), [1, 0, 0, 0], r"weights has the shape \(3, 1\)"), (numpy.ones(2), [1, 0, 0, 0], "2 weights"),
                                         (numpy.ones(3), [1, 0, 0], "the polynomial has 3 numbers; 4 are needed")):
        with pytest.raises(kontur.InvalidInputError, match=problem):
            kontur.ImplicitFunction("biharmonic", [0, 0, 0], 1, numpy.eye(3), weights, polynomial)


@pytest.mark.parametrize(
    "dtype, low, high, stored",
    [
        ("uint8", 0, 255, "uint8"),
        ("bool", 0, 1, "uint8"),
        ("int16", -5, 5, "int16"),
        ("uint16", 0, 60000, "uint16"),
        ("int32", -70000, 70000, "int32"),
        ("float32", -1.5, 1.5, "float32"),
        ("float64", -1.5, 1.5, "float32"),
        ("int8", -5, 5, "int16"),
        ("int64", 0, 200, "uint8"),
        ("int64", -1024, 3000, "int16"),
        ("uint32", 0, 60000, "uint16"),
        ("int64", -70000, 70000, "int32"),
        (">i2", -5, 300, "int16"),
    ],
)
def test_an_image_keeps_values_of_every_type(oblique, dtype, low, high, stored):
    samples = numpy.linspace(low, high, 60).astype(dtype).reshape(oblique.shape)
    image = kontur.Image(samples, oblique)
    assert image.samples.dtype == stored
    assert numpy.array_equal(image.samples, samples.astype(stored))
    assert numpy.array_equal(numpy.asarray(image), image.samples)


def test_an_image_refuses_values_that_it_would_change(oblique):
    def image(value, dtype):
        return kontur.Image(numpy.full(oblique.shape, value, dtype), oblique)

    for value, dtype in ((2**40, "uint64"), (-(2**63), "int64"), (3 * 2**62, "uint64"), (-(2**31) - 2**8, "int64")):
        assert image(value, dtype).samples.dtype == "float32"
        assert (image(value, dtype).samples.astype(dtype) == value).all()
    for value, dtype in ((3000000001, "uint32"), (2**40 + 1, "int64"), (-(2**31) - 1, "int64"), (2**64 - 1, "uint64")):
        with pytest.raises(kontur.UnsupportedError, match=f"the sample {value} fits neither"):
            image(value, dtype)
    with pytest.raises(kontur.UnsupportedError, match=r"the sample 1e\+300 is beyond"):
        image(1e300, "float64")
    assert numpy.isposinf(image(numpy.inf, "float64").samples).all()
    assert numpy.isnan(image(numpy.nan, "float64").samples).all()


def test_a_mask_of_anything_but_numbers_is_refused(oblique):
    for array in (numpy.full(oblique.shape, "a"), numpy.full(oblique.shape, None), numpy.zeros(oblique.shape, complex)):
        with pytest.raises(kontur.UnsupportedError, match="mask values of type .* are no real numbers"):
            kontur.Mask(array, oblique)


def test_no_array_changes_its_numbers_on_the_way_in(tmp_path):
    for points in (numpy.array(SQUARE) * (1 + 0j), numpy.array(SQUARE).astype(str), [["a", "b", "c"]] * 3):
        with pytest.raises(kontur.InvalidInputError, match="real numbers are needed"):
            kontur.Contour(points)
    for points in (numpy.array(SQUARE, "float32"), numpy.array(SQUARE, object), numpy.asfortranarray(SQUARE)):
        assert kontur.Contour(points).points.tolist() == SQUARE
    for pixels, problem in ((300, "the value 300; 0 to 255 are"), (-1, "the value -1"), (0.99, "float64; whole numbers are needed")):
        with pytest.raises(kontur.InvalidInputError, match=problem):
            kontur.write_png(tmp_path / "picture.png", numpy.full((4, 4, 3), pixels))
    kontur.write_png(tmp_path / "picture.png", numpy.full((4, 4, 3), 255))
    with pytest.raises(kontur.InvalidInputError, match="the value 1099511627776"):
        kontur.stages.smooth_path(kontur.stages.EdgeMap(numpy.eye(9)), numpy.full((3, 2), 2**40))
    for triangles in ([[0, 1, 1.9]], [[0, 1, 2**63]]):
        with pytest.raises(kontur.InvalidInputError):
            kontur.TriangleMesh(numpy.eye(3), triangles)


def test_more_than_fits_into_memory_is_refused(case, oblique):
    image = kontur.Image(numpy.zeros(oblique.shape), oblique)
    plane = kontur.Plane([0, 0, 0], [0, 0, 1])
    for pixels in (2**31 - 1, 100_000):
        with pytest.raises(kontur.TooLargeError, match=f"{pixels} x {pixels} pixels"):
            kontur.reslice(image, plane, pixels, pixels, 1.0, 0.0)
    if SANITIZED:
        return
    with pytest.raises(kontur.TooLargeError, match="memory"):
        kontur.make_truth_mask(case.body, kontur.Grid((2**20, 2**20, 2**10), numpy.eye(4), frame="LPS"))


def test_an_image_of_complex_numbers_is_refused(oblique):
    with pytest.raises(kontur.UnsupportedError, match="complex64"):
        kontur.Image(numpy.zeros(oblique.shape, "complex64"), oblique)


def test_labels(oblique):
    labels = numpy.arange(60).reshape(oblique.shape) // 20
    image = kontur.Image(labels, oblique)
    assert kontur.count_labels(image) == {1: 20, 2: 20}
    assert numpy.array_equal(kontur.select_label(image, 2).values, labels == 2)
    assert numpy.array_equal(kontur.select_nonzero(image).values, labels > 0)


def test_interpolation_meets_the_voxels(oblique):
    image = kontur.Image(numpy.random.default_rng(1).normal(size=oblique.shape).astype("f"), oblique)
    centers = (oblique.index_to_mm @ [[0, 4], [0, 3], [0, 2], [1, 1]])[:3].T
    assert numpy.allclose(kontur.interpolate(image, centers, outside=-9), image.samples[[0, 2], [0, 3], [0, 4]], atol=1e-5)
    assert kontur.interpolate(image, [[1e3, 0, 0]], outside=-9).tolist() == [-9]


def test_a_mesh_must_fit_together():
    for triangles in ([[0, 1, 3]], [[0, 1, -1]], [[0, 1]]):
        with pytest.raises(kontur.InvalidInputError):
            kontur.TriangleMesh(numpy.eye(3), triangles)
    with pytest.raises(kontur.InvalidInputError, match="2 normals"):
        kontur.TriangleMesh(numpy.eye(3), [[0, 1, 2]], normals=numpy.eye(3)[:2])


@pytest.mark.parametrize("clone", [copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
def test_values_can_be_copied_and_pickled(case, kidney, clone):
    assert clone(case.grid) == case.grid
    assert clone(case.contours) == case.contours
    about = kontur.StructureAttributes((1, 2, 255), "GTV", "MANUAL", "in words", 7, kontur.CodedConcept("1", "SCT", "a"),
                                       kontur.CodedConcept("2", "SCT"), [kontur.PhysicalProperty("REL_ELEC_DENSITY", 1.2)],
                                       kontur.Review(kontur.Approval("Doe", "2026-11-30T21:02:43"), "to the rim", True))
    told = kontur.ContourSet(case.contours.contours, attributes=about)
    assert clone(about) == about and clone(told).attributes == told[::2].attributes == about and told != case.contours
    assert numpy.array_equal(clone(kidney.mask).values, kidney.mask.values)
    image = kontur.Image(kidney.mask.values * 1000.0, case.grid)
    assert numpy.array_equal(clone(image).samples, image.samples)
    for name in ("points", "triangles", "normals"):
        assert numpy.array_equal(getattr(clone(kidney.mesh), name), getattr(kidney.mesh, name))
    points = case.contours.contours[0].points
    assert numpy.array_equal(clone(kidney.function)(points), kidney.function(points))
