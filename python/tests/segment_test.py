# SPDX-License-Identifier: Apache-2.0
"""The pipeline, whole and in stages; progress, cancellation, errors."""
import _thread
import pickle
import signal
import threading
import time

import kontur
import numpy
import pytest


def test_the_kidney(case, kidney):
    truth = kontur.make_truth_mask(case.body, case.grid)
    agreement = kontur.compare(kidney.mask, truth)
    assert agreement.dice > 0.97
    assert agreement.surface.mean_surface_distance_mm < 1
    report = kidney.report
    assert report.contours == len(case.contours) == 6
    assert report.points == case.contours.point_count
    assert report.mask_voxels == kidney.mask.values.sum()
    assert report.mask_volume_ml == pytest.approx(kidney.mask.volume_ml)
    assert report.mask_components == 1
    assert 0 < report.residual.rms_mm <= report.residual.max_mm < 0.1
    assert set(report.seconds) == {"prepare", "fit", "voxelize", "polygonize", "check", "measure"}
    assert kontur.segment(case.contours, case.grid, quality=0.2).mesh is None


def test_the_stages_make_what_segment_makes(case, kidney):
    prepared = kontur.stages.prepare(case.contours)
    fitted = kontur.stages.fit(prepared)
    assert (fitted.solves, fitted.bounded) == (kidney.report.solves, kidney.report.bounded)
    starts = numpy.concatenate([prepared.positions] + [contour.points for contour in case.contours.contours])
    surface = kontur.stages.track_surface_adaptively(fitted.function, case.grid, starts)
    assert numpy.array_equal(kontur.stages.fill(surface).values, kidney.mask.values)
    mesh = kontur.stages.polygonize(surface, fitted.function)
    assert numpy.array_equal(mesh.points, kidney.mesh.points)
    assert numpy.array_equal(mesh.triangles, kidney.mesh.triangles)
    assert kontur.stages.residual(fitted.function, case.contours).max_mm == kidney.report.residual.max_mm


def test_of_two_contours_that_yield_the_heavier_yields_less():
    """`reconcile` by itself, as within `segment`."""
    def least_trust(weight):
        angles = numpy.linspace(0, 2 * numpy.pi, 90, endpoint=False)
        ring = numpy.stack([numpy.cos(angles), numpy.sin(angles), 0 * angles], axis=1)
        circles = [kontur.Contour(20 * ring, weight=weight), kontur.Contour(21.5 * ring[:, [2, 0, 1]])]
        contours = kontur.ContourSet(circles)
        yielded = kontur.stages.reconcile(kontur.stages.prepare(contours, conflicts="exact"), kontur.stages.find_crossings(contours))
        return min(yielded.trust[yielded.contours == 0]) / weight

    assert least_trust(9) > 3 * least_trust(1)


def lens(center, radius):
    """A ball as seven axial circles."""
    turns = numpy.linspace(0, 2 * numpy.pi, 40, endpoint=False)
    contours = []
    for z in numpy.linspace(-0.9, 0.9, 7) * radius:
        ring = (radius**2 - z**2) ** 0.5 * numpy.stack([numpy.cos(turns), numpy.sin(turns), 0 * turns], 1)
        points = ring + center + [0, 0, z]
        contours.append(kontur.Contour(points))
    return contours


def test_several_structures_become_a_partition():
    sets = [kontur.ContourSet(lens(center, radius), name=name)
            for name, center, radius in (("left", (-7, 0, 0), 12), ("right", (7, 0, 0), 12), ("core", (-10, 0, 0), 4))]
    grid = kontur.grid_around(kontur.ContourSet([*sets[0], *sets[1]]).bounding_box, spacing_mm=[1, 1, 1], margin_mm=4)
    made = kontur.segment_together(sets, grid, rules=[("right", "exclusive", 0)], quality=0.9)
    assert {(pair.first, pair.relation, pair.second, pair.is_given) for pair in made.pairs} == {
        (1, "exclusive", 0, True), (2, "inside", 0, False)}
    left, right, core = (made.mask(n).values.astype(bool) for n in range(3))
    assert left.shape == grid.shape and not (left & right).any() and (core & left).sum() == core.sum() > 0
    assert made.contested_voxels == [pair.shared_voxels for pair in made.pairs if pair.relation == "exclusive"][0] > 0
    assert made.structures[2].mask.values.size < left.size / 10
    assert [one.report.mask_voxels for one in made.structures] == [mask.sum() for mask in (left, right, core)]
    overlapping = kontur.segment_together(sets[:2], grid, rules=[(0, "overlap", 1)], quality=0.9)
    for n in range(2):
        alone = kontur.segment(sets[n], grid, quality=0.9).mask.values
        assert (overlapping.mask(n).values != alone).sum() <= 2  # found in a smaller box
    with pytest.raises(IndexError):
        made.mask(3)


def test_structures_share_one_surface(tmp_path):
    sets = [kontur.ContourSet(lens((x, 0, 0), radius)) for x, radius in ((-7, 12), (7, 12), (-10, 4))]
    grid = kontur.grid_around(kontur.ContourSet([*sets[0], *sets[1]]).bounding_box, spacing_mm=[1, 1, 1], margin_mm=4)
    made = kontur.segment_together(sets, grid, quality=0.9)
    surface = kontur.shared_surface(made, threads=1)
    assert surface.regions[0] == [] and [0] in surface.regions and [0, 2] in surface.regions
    behind, front = surface.sides.T
    assert len(behind) == len(surface.mesh.triangles) and surface.sides.dtype == numpy.uint32 and (behind != front).all()
    touching = {surface.regions.index([0]), surface.regions.index([1])}
    assert sum({a, b} == touching for a, b in surface.sides.tolist()) > 100  # one border, and not two
    for n in range(3):
        own = kontur.surface_of(surface, n)
        volume = made.mask(n).values.sum()
        assert kontur.topology(own).closed and abs(kontur.signed_volume_mm3(own) / volume - 1) < 0.08
    assert len(kontur.surface_of(surface, 3).triangles) == 0
    names = [" and ".join(map(str, region)) or "outside" for region in surface.regions]
    kontur.write_region_mesh(tmp_path / "all.ply", surface.mesh, names, surface.sides)
    assert b"comment kontur region 1: 0\n" in (tmp_path / "all.ply").read_bytes()
    assert (kontur.read_mesh(tmp_path / "all.ply").triangles == surface.mesh.triangles).all()
    with pytest.raises(kontur.InvalidInputError, match="0 pairs of regions"):
        kontur.write_region_mesh(tmp_path / "none.ply", surface.mesh, names, numpy.zeros((0, 2)))
    with pytest.raises(kontur.InvalidInputError, match=r"\(3,\); \(m, 2\) is needed"):
        kontur.write_region_mesh(tmp_path / "none.ply", surface.mesh, names, [0, 1, 2])
    assert not (tmp_path / "none.ply").exists()
    again = pickle.loads(pickle.dumps(surface))
    assert (again.sides == surface.sides).all() and again.regions == surface.regions


@pytest.mark.parametrize("rules, sentence", [
    ([("left", "inside", "top")], "a rule is about 'top', which 0 structures are called; 1 is needed"),
    ([("left", "inside")], "a rule has 2 parts; 3 are needed"),
    ([(0, "inside", 2)], "the structures 0 and 2; there are 2"),
    ([(0, "inside", 1), (1, "overlap", 0)], "2 rules are about the structures 1 and 0; 1 is possible"),
])
def test_rules_that_make_no_sense(rules, sentence):
    sets = [kontur.ContourSet(lens((x, 0, 0), 6), name=name) for x, name in ((0, "left"), (9, "right"))]
    with pytest.raises(kontur.InvalidInputError, match=sentence):
        kontur.segment_together(sets, kontur.grid_around(sets[0].bounding_box, [1, 1, 1], 5), rules=rules)


def test_labels_are_filled_by_what_the_image_shows():
    z, y, x = numpy.mgrid[:43, :40, :44]
    inside = (y - 20) ** 2 + (x - 22 - 3 * numpy.sin(0.55 * z)) ** 2 < 100
    full = (inside & (z > 3) & (z < 41)).astype("uint8")
    sparse = numpy.where(z % 6 == 4, full, 0)
    grid = kontur.Grid.from_spacing(full.shape[::-1], [1, 1, 1])
    noise = numpy.random.default_rng(1).normal(0, 5, full.shape)
    image = kontur.Image((numpy.where(inside, 180, 60) + noise).astype("int16"), grid)
    filled, report = kontur.fill_labels(sparse, (1, 1, 1), image=image, return_report=True)
    alone = kontur.fill_labels(sparse, (1, 1, 1))
    assert report.labels[0].image.verdict == "used"
    assert (filled != full).sum() < 0.8 * (alone != full).sum()
    assert (filled[sparse > 0] == 1).all()


def test_values_and_gradients(case, kidney):
    points = numpy.concatenate([contour.points for contour in case.contours.contours])
    assert abs(kidney.function(points)).max() < 0.02
    grid_of_points = points[:12].reshape(3, 4, 3)
    assert kidney.function.values(grid_of_points).shape == (3, 4)
    assert kidney.function(points[0]).shape == ()
    gradients = kidney.function.gradients(grid_of_points)
    step = 1e-4
    for axis in range(3):
        shift = step * numpy.eye(3)[axis]
        difference = (kidney.function(grid_of_points + shift) - kidney.function(grid_of_points - shift)) / (2 * step)
        assert numpy.allclose(gradients[..., axis], difference, atol=1e-6)
    with pytest.raises(kontur.InvalidInputError, match=r"\(\.\.\., 3\) is needed"):
        kidney.function([1.0, 2.0])


def test_the_function_is_the_sum_that_its_parts_say(kidney):
    f = kidney.function
    points = numpy.random.default_rng(3).normal(scale=20, size=(5, 3)) + f.frame_center_mm
    unit = (points - f.frame_center_mm) / f.frame_scale_mm
    radii = numpy.linalg.norm(unit[:, None] - f.centers, axis=2)
    kernel = 192 * (1 + radii / 4) * numpy.exp(-radii / 4)
    assert f.kernel == "screened" and (f.polynomial[1:] == 0).all() and f.polynomial[0] == -f.frame_scale_mm
    assert numpy.allclose(f(points), kernel @ f.weights + f.polynomial[0], rtol=1e-9, atol=1e-8)


def test_far_from_all_that_was_drawn_the_function_falls(case, kidney):
    centre, radius = case.contours.smallest_ball
    assert numpy.allclose(centre, kidney.function.frame_center_mm) and radius == kidney.function.frame_scale_mm
    directions = numpy.random.default_rng(4).normal(size=(100, 3))
    directions /= numpy.linalg.norm(directions, axis=1, keepdims=True)
    assert (kidney.function(centre + 2 * radius * directions) < 0).all()
    farthest = max(1.25, numpy.linalg.norm(kidney.function.centers, axis=1).max())
    fall = -16 * radius * (300 - farthest) ** 3
    assert numpy.allclose(kidney.function(centre + 300 * radius * directions), fall - radius, rtol=1e-12)


def test_threads_do_not_change_a_byte(case, kidney):
    for threads in (1, 3):
        other = kontur.segment(case.contours, case.grid, mesh=True, threads=threads)
        assert other.mask.values.tobytes() == kidney.mask.values.tobytes()
        assert other.mesh.points.tobytes() == kidney.mesh.points.tobytes()


def test_options_arrive(case):
    report = kontur.segment(case.contours, case.grid, kernel="biharmonic", quality=0.2, smoothing=1e-3, normals="in-plane",
                            normal_offset_mm=1, solver="dense", voxelizer="exhaustive").report
    assert (report.kernel, report.quality, report.smoothing, report.normals, report.normal_offset_mm) == (
        "biharmonic", 0.2, 1e-3, "in-plane", 1)
    assert (report.solver, report.voxelizer, report.iterations) == ("dense", "exhaustive", 0)
    assert report.evaluations == case.grid.voxel_count


def test_wrong_options_are_refused_by_name(case):
    with pytest.raises(TypeError, match=r"segment\(\) got an unexpected keyword argument 'qualty'"):
        kontur.segment(case.contours, case.grid, qualty=0.5)
    with pytest.raises(TypeError, match="quality: float is needed, not 'high'"):
        kontur.segment(case.contours, case.grid, quality="high")
    with pytest.raises(ValueError, match="^kernel: 'cubic' is none of {'screened', 'triharmonic', 'biharmonic'}"):
        kontur.segment(case.contours, case.grid, kernel="cubic")
    with pytest.raises(kontur.InvalidInputError, match="quality"):
        kontur.segment(case.contours, case.grid, quality=0)


def test_words_and_arrays_that_cannot_be_used_are_named_by_their_argument(case):
    points = case.contours[0].points
    for name, refused in {
        "end": lambda: kontur.Contour(points, end="square"),
        "frame": lambda: kontur.Grid((2, 2, 2), numpy.eye(4), frame="XYZ"),
        "among": lambda: kontur.suggest_planes(kontur.segment(case.contours, case.grid), case.contours, among="some"),
        "origin": lambda: kontur.Plane([1, 2], [0, 0, 1]),
        "interior": lambda: kontur.ContourSet([], interior=[[1, 2]]),
        "surface": lambda: kontur.ContourSet([], surface=[[1, 2]]),
    }.items():
        with pytest.raises(kontur.InvalidInputError, match=f"^{name}: "):
            refused()


def test_points_on_the_surface_may_be_an_array():
    positions = numpy.arange(6.0).reshape(2, 3)
    plain = kontur.ContourSet([], surface=positions)
    assert plain.surface == [kontur.SurfacePoint(row) for row in positions]
    outward = numpy.hstack([positions, [[0, 0, 1], [1, 0, 0]]])
    assert kontur.ContourSet([], surface=outward).surface == [kontur.SurfacePoint(row[:3], row[3:]) for row in outward]
    assert kontur.ContourSet([], surface=numpy.empty((0, 3))).surface == []


def test_options_out_of_their_range_are_refused_before_any_work(case, tmp_path):
    nan = float("nan")
    for editor in (kontur.Editor, lambda **options: kontur.LiveEditor(print, **options)):
        for option in ("preview_spacing_mm", "finished_spacing_mm"):
            with pytest.raises(kontur.InvalidInputError, match="spacing is nan mm; it must be finite and at least 0"):
                editor(**{option: nan})
    with pytest.raises(kontur.InvalidInputError, match="the window's width is 0"):
        kontur.make_picture(kontur.TriangleMesh(numpy.empty((0, 3)), numpy.empty((0, 3), int)), case.contours, window=(40, 0))
    path = tmp_path / "contours.mrk.json"
    kontur.write_contours(path, case.contours)
    with pytest.raises(kontur.InvalidInputError, match="the tolerance for points off their plane is nan mm"):
        kontur.read_contours(path, plane_tolerance_mm=nan)


def test_progress_is_called_on_this_thread_from_0_to_1(case):
    calls = []
    kontur.segment(case.contours, case.grid, progress=lambda *words: calls.append((threading.get_ident(), *words)))
    assert {thread for thread, _, _ in calls} == {threading.get_ident()}
    assert all(isinstance(stage, str) and 0 <= fraction <= 1 for _, stage, fraction in calls)
    assert len({stage for _, stage, _ in calls}) > 1


# Each voxel of 100 million evaluated: minutes.
def endless(case, **more):
    grid = kontur.grid_around(case.contours.bounding_box, [0.15] * 3, 20)
    return kontur.segment(case.contours, grid, voxelizer="exhaustive", **more)


def test_an_exception_of_the_callback_stops_the_work(case):
    class Enough(Exception):
        pass

    def progress(stage, fraction):
        raise Enough(stage)

    with pytest.raises(Enough):
        endless(case, progress=progress)


def test_an_event_stops_the_work(case):
    event = threading.Event()
    timer = threading.Timer(0.5, event.set)
    timer.start()
    with pytest.raises(kontur.CancelledError) as error:
        endless(case, stop=event)
    assert error.value.kind == "cancelled"


def test_an_interrupt_stops_the_work(case):
    timer = threading.Timer(0.5, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        endless(case)


def test_a_signal_handler_may_raise(case):
    class Alarm(Exception):
        pass

    def handler(number, frame):
        raise Alarm

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(Alarm):
            endless(case)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_other_threads_run_meanwhile(case):
    count, event = 0, threading.Event()

    def work():
        with pytest.raises(kontur.CancelledError):
            endless(case, stop=event)

    thread = threading.Thread(target=work)
    thread.start()
    end = time.monotonic() + 0.5
    while time.monotonic() < end:
        count += 1
    event.set()
    thread.join()
    assert count > 1000


@pytest.mark.parametrize(
    "error, builtin, kind, call",
    [
        (kontur.InvalidInputError, ValueError, "invalid_input", lambda path: kontur.phantom_case("none")),
        (kontur.UnsupportedError, NotImplementedError, "unsupported", lambda path: kontur.read_mesh(path / "mesh.xyz")),
        (kontur.CorruptFileError, ValueError, "corrupt_file", lambda path: kontur.read_image(path / "empty.nii")),
        (kontur.FileError, OSError, "io", lambda path: kontur.read_image(path / "missing.nii")),
        (kontur.SingularSystemError, ArithmeticError, "singular_system",
         lambda path: kontur.stages.solve(kontur.stages.ConstraintSet(numpy.eye(3)[[0, 1, 2, 2, 0]] * [1, 1, 0], [0, 0, 0, 0, 1]))),
        (kontur.TooLargeError, MemoryError, "too_large",
         lambda path: kontur.read_image(path / "grid.nrrd", max_voxels=10)),
    ],
)
def test_each_kind_of_error_is_an_exception_of_its_own(tmp_path, oblique, error, builtin, kind, call):
    for name in ("empty.nii", "mesh.xyz"):
        (tmp_path / name).write_bytes(b"")
    kontur.write_image(tmp_path / "grid.nrrd", kontur.Image(numpy.zeros(oblique.shape, "u1"), oblique))
    with pytest.raises(error) as caught:
        call(tmp_path)
    assert isinstance(caught.value, builtin) and isinstance(caught.value, kontur.Error)
    assert caught.value.kind == kind
    assert len(str(caught.value)) > 10


def test_one_exception_for_each_kind_of_the_library():
    assert {error.kind for error in kontur.Error.__subclasses__()} == set(kontur._core._error_kinds())


def test_a_preview_is_a_closed_surface_about_the_mask(case, kidney):
    starts = numpy.concatenate([contour.points for contour in case.contours.contours])
    preview = kontur.stages.preview_surface(kidney.function, starts, spacing_mm=4)
    assert kontur.topology(preview).closed
    assert kontur.signed_volume_mm3(preview) / 1000 == pytest.approx(kidney.report.mask_volume_ml, rel=0.02)
    assert len(preview.triangles) < len(kidney.mesh.triangles) / 4


def test_an_argument_of_another_type_is_named_in_one_sentence():
    case = kontur.phantom_case("kidney_radial6")
    points = numpy.zeros((1000, 3))
    for call, sentence in [
        (lambda: kontur.segment(points, case.grid), "segment(): contours: ContourSet is needed, not an array of shape (1000, 3)"),
        (lambda: kontur.segment(case.contours, None), "segment(): grid: Grid is needed, not None"),
        (lambda: kontur.segment(case.contours, case.grid, image=points), "segment(): image: Image is needed, not an array of shape (1000, 3)"),
        (lambda: kontur.ContourSet([points]), "ContourSet(): contours: List[Contour] is needed, not an object of type list"),
        (lambda: kontur.Contour(points, plane=3), "Contour(): plane: Optional[Plane] is needed, not 3"),
        (lambda: kontur.compare("a", "b"), "compare(): a: Mask is needed, not 'a'"),
    ]:
        with pytest.raises(TypeError) as refused:
            call()
        assert str(refused.value) == sentence
