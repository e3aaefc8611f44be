# SPDX-License-Identifier: Apache-2.0
"""Contours drawn at some moments, masks at all of them."""
import os
import pickle
import subprocess

import kontur
import numpy
import pytest

FRAMES = 8


def ball(frame, radius):
    angles = numpy.linspace(0, 2 * numpy.pi, 48, endpoint=False)
    contours = []
    for z in (-12, -4, 4, 12):
        r = numpy.sqrt(radius**2 - z**2)
        contours.append(kontur.Contour(numpy.c_[r * numpy.cos(angles), r * numpy.sin(angles), 0 * angles + z], frame=frame))
    return contours


@pytest.fixture(name="contours", scope="module")
def contours_fixture():
    return kontur.ContourSet(ball(1, 20) + ball(5, 16), name="ball", cycle_frames=FRAMES)


@pytest.fixture(name="grid", scope="module")
def grid_fixture():
    return kontur.grid_around([[-24, -24, -24], [24, 24, 24]], [2, 2, 2], 0)


@pytest.fixture(name="made", scope="module")
def made_fixture(contours, grid):
    return kontur.segment_moving(contours, grid, range(1, FRAMES + 1))


def test_masks_volumes_and_the_function(made, grid):
    assert len(made.masks) == FRAMES and made.times == list(range(1, FRAMES + 1))
    assert made.volumes.volumes_ml == pytest.approx([mask.volume_ml for mask in made.masks])
    assert (made.volumes.largest, made.volumes.smallest) == (0, 4)
    assert made.volumes.ejection_fraction == pytest.approx(1 - 0.8**3, abs=0.03)
    assert [(m.time, m.contours, m.carried) for m in made.moments] == [(1, 4, 0), (5, 4, 0)]
    k, j, i = numpy.indices(grid.shape)
    affine = numpy.array(grid.index_to_mm)
    centres = numpy.stack([i, j, k], -1) @ affine[:3, :3].T + affine[:3, 3]
    for frame in (1, 3, 7):
        assert numpy.array_equal(made.function(centres, frame) > 0, made.masks[frame - 1].values.astype(bool))
    assert made.function.values([18, 0, 0], 3).shape == ()


def test_each_volume_has_an_interval_and_so_has_the_fraction(made):
    for one, ml in zip(made.volumes.intervals, made.volumes.volumes_ml):
        assert one.low_ml < ml < one.high_ml
    low, high = made.volumes.ejection_interval
    assert 0 < low < made.volumes.ejection_fraction < high < 1


def test_frames_have_surfaces_where_they_are_asked_for(contours, grid, made):
    assert made.meshes == []
    meshes = kontur.segment_moving(contours, grid, range(1, FRAMES + 1), mesh=True).meshes
    for mesh, ml in zip(meshes, made.volumes.volumes_ml, strict=True):
        assert kontur.signed_volume_mm3(mesh) / 1000 == pytest.approx(ml, rel=0.03)


def test_whole_moments_follow_the_images_of_their_times(contours, grid, made):
    images = [kontur.Image(numpy.where(mask.values, 900, 100).astype("int16"), grid) for mask in made.masks]
    followed = kontur.segment_moving(contours, grid, range(1, FRAMES + 1), images=images)
    still = kontur.ContourSet([kontur.Contour(c.points, c.plane) for c in contours[4:]])
    assert numpy.array_equal(followed.masks[4].values, kontur.segment(still, grid, image=images[4]).mask.values)
    with pytest.raises(kontur.InvalidInputError, match="there are 2 images"):
        kontur.segment_moving(contours, grid, range(1, FRAMES + 1), images=images[:2])


def test_contours_keep_their_moment(contours, tmp_path):
    assert kontur.is_moving(contours) and not kontur.is_moving(contours[:4])
    assert contours[4].frame == 5 and contours[4].time_s is None
    assert pickle.loads(pickle.dumps(contours)) == contours
    assert kontur.Contour(contours[0].points, contours[0].plane) != contours[0]
    kontur.write_contours(tmp_path / "a.json", contours)
    assert kontur.read_contours(tmp_path / "a.json") == contours
    with pytest.raises(kontur.InvalidInputError, match="contour 1 was drawn in frame 1 and contour 5 in frame 5"):
        kontur.check_contours(contours)


def test_the_function_comes_through_a_pickle(made):
    again = pickle.loads(pickle.dumps(made.function))
    assert again([1, 2, 19], 2.5) == made.function([1, 2, 19], 2.5)
    assert (again.times, again.cycle) == ([1, 5], FRAMES)


def test_the_command_line_makes_the_same_masks(contours, grid, made, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    kontur.write_contours(tmp_path / "a.json", contours)
    kontur.write_mask(tmp_path / "one.nii.gz", made.masks[0])
    one = nibabel.load(tmp_path / "one.nii.gz")
    nibabel.save(nibabel.Nifti1Image(numpy.zeros((*one.shape, FRAMES), numpy.int16), one.affine), tmp_path / "cine.nii.gz")
    subprocess.run([os.environ["KONTUR_CLI"], "segment", tmp_path / "a.json", "--image", tmp_path / "cine.nii.gz", "--output",
                    tmp_path / "masks.nii.gz"], check=True)
    masks = numpy.asarray(nibabel.load(tmp_path / "masks.nii.gz").dataobj)
    for n, mask in enumerate(made.masks):
        assert numpy.array_equal(masks[..., n].T, mask.values)


def test_bad_input_is_refused(contours, grid):
    with pytest.raises(kontur.InvalidInputError, match="contour 5 lies at frame 5, and the image's frames go from 1 to 4"):
        kontur.segment_moving(contours, grid, range(1, 5))
    with pytest.raises(kontur.InvalidInputError, match="moment 2 is at 1, not after 1"):
        kontur.MovingFunction([1, 1], [kontur.ImplicitFunction("biharmonic", [0, 0, 0], 1, [[0, 0, 0]], [1], [0, 0, 0, 0])] * 2)


def test_the_frame_that_is_least_sure_is_suggested_first(made):
    first, second = kontur.suggest_moving(made, 2)
    widths = [one.high_ml - one.low_ml for one in made.volumes.intervals]
    assert widths[first.frame] == max(widths) and first.frame != second.frame
    with pytest.raises(kontur.InvalidInputError, match="0 planes are asked for"):
        kontur.suggest_moving(made, 0)


def test_the_band_is_wider_between_moments(contours, grid):
    moving = kontur.segment_moving(contours, grid, range(1, FRAMES + 1), mesh=True)
    times = [m.time for m in moving.moments]
    mean = [kontur.moving_half_widths_mm(moving, mesh.points, n + 1).mean() for n, mesh in enumerate(moving.meshes)]
    between = numpy.mean([w for n, w in enumerate(mean) if n + 1 not in times])
    assert between > numpy.mean([mean[int(t) - 1] for t in times])


def test_a_folder_of_files_is_read_frame_by_frame(tmp_path, contours, grid, made):
    for frame in range(1, FRAMES + 1):
        image = kontur.Image(numpy.full(grid.shape, frame, numpy.int16), grid)
        kontur.write_image(tmp_path / f"frame {3 * frame}.nrrd", image)
    frames = kontur.read_image_frames(tmp_path)
    assert (frames.count, frames.step_s, frames.cycle_frames) == (FRAMES, None, None)
    assert frames.order.startswith(f"the {FRAMES} frames are files in this order: frame 3.nrrd to frame {3 * FRAMES}.nrrd")
    images = [kontur.read_image(tmp_path, frame=n) for n in range(1, frames.count + 1)]
    assert [int(image.samples.max()) for image in images] == list(range(1, FRAMES + 1))
    moving = kontur.segment_moving(contours, kontur.read_grid(tmp_path, frame=1), range(1, frames.count + 1))
    assert all(numpy.array_equal(one.values, other.values) for one, other in zip(moving.masks, made.masks))
    (tmp_path / "frame 3.nrrd").unlink()
    last = kontur.read_image(tmp_path, frame=FRAMES, frames=frames)
    assert numpy.array_equal(last.samples, images[-1].samples), "of a known folder other files are not looked at"
    with pytest.raises(kontur.InvalidInputError, match=f"has no frame {FRAMES + 1}; it has 1 to {FRAMES}"):
        kontur.read_image(tmp_path, frame=FRAMES + 1, frames=frames)
    with pytest.raises(kontur.UnsupportedError, match=f"holds {FRAMES - 1} images"):
        kontur.read_image(tmp_path)
