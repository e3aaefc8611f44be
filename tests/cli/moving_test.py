# SPDX-License-Identifier: Apache-2.0
"""kontur segment of contours drawn in several frames: masks of all frames, volumes, refusals."""
import copy
import csv
import json
import pathlib
import subprocess
import sys

import nibabel
import numpy
import pydicom
import pytest
from support import circle, kontur, names, succeed

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
import make_dicom_series as dicom

FRAMES = 8
SPACING = 1.5
HALF = 18.0


def radius(frame):
    """Of the ball, mm: the largest in frame 1, the smallest in frame 5."""
    return 11 + 3 * numpy.cos(2 * numpy.pi * (frame - 1) / FRAMES)


@pytest.fixture(name="cine")
def cine_fixture(tmp_path):
    """An empty image of 8 frames, 40 ms apart, in LPS from -18 mm on."""
    affine = numpy.diag([-SPACING, -SPACING, SPACING, 1.0])
    affine[:3, 3] = HALF, HALF, -HALF
    image = nibabel.Nifti1Image(numpy.zeros((25, 25, 25, FRAMES), numpy.int16), affine)
    image.set_sform(affine, 1)
    image.header.set_xyzt_units("mm", "msec")
    image.header["pixdim"][4] = 40
    nibabel.save(image, tmp_path / "cine.nii.gz")
    return tmp_path / "cine.nii.gz"


@pytest.fixture(name="beats")
def beats_fixture(tmp_path):
    """The same as a series of a gated scan."""
    folder = tmp_path / "beats"
    dicom.write_cine(folder, FRAMES, 25, SPACING, -HALF)
    return folder


def ball(frame, offsets=(-6.0, -2.0, 2.0, 6.0)):
    planes = [circle("z", offset, center=(0, 0, 0), radius=radius(frame)) for offset in offsets]
    for plane in planes:
        plane["contours"][0]["frame"] = frame
    return planes


def write(path, planes, **more):
    path.write_text(json.dumps({"frame": "LPS mm", "structure": "ball", "planes": planes, **more}))
    return path


@pytest.fixture(name="contours")
def contours_fixture(tmp_path):
    return write(tmp_path / "ball.json", ball(1) + ball(5), cycle_frames=FRAMES)


def refusal(*words):
    result = kontur("segment", *words)
    assert result.returncode == 65, result
    return result.stderr


def test_masks_of_all_frames_and_their_volumes(tmp_path, cine, contours):
    said = succeed("segment", contours, "--image", cine, "--output", tmp_path / "masks.nii.gz", "--volumes", tmp_path / "v.csv",
                   "--report", tmp_path / "r.json")
    masks = nibabel.load(tmp_path / "masks.nii.gz")
    assert masks.shape == (25, 25, 25, FRAMES)
    assert numpy.abs(masks.affine - nibabel.load(cine).affine).max() < 1e-5
    assert masks.header["pixdim"][4] == pytest.approx(0.04)
    assert masks.header.get_xyzt_units() == ("mm", "sec")
    rows = list(csv.DictReader((tmp_path / "v.csv").open()))
    voxels = numpy.asarray(masks.dataobj).sum((0, 1, 2))
    assert [float(row["volume_ml"]) for row in rows] == pytest.approx(voxels * SPACING**3 / 1000, abs=1e-3)
    assert [row["frame"] for row in rows] == [str(n + 1) for n in range(FRAMES)]
    assert [row["contours"] for row in rows] == ["4", "0", "0", "0", "4", "0", "0", "0"]
    assert [row["phase"] for row in rows] == ["largest", "", "", "", "smallest", "", "", ""]
    widths = [float(row["high_ml"]) - float(row["low_ml"]) for row in rows]
    assert all(float(row["low_ml"]) < float(row["volume_ml"]) < float(row["high_ml"]) for row in rows)
    assert min(widths[2], widths[6]) > 2 * max(widths[0], widths[4])  # half of the way between what was drawn
    assert float(rows[2]["time_s"]) == pytest.approx(0.08)
    truth = 1 - (radius(5) / radius(1)) ** 3
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["ejection_fraction"] == pytest.approx(truth, abs=0.04)
    assert (report["largest_frame"], report["smallest_frame"]) == (1, 5)
    assert report["ejection_fraction_low"] < truth < report["ejection_fraction_high"]
    assert [float(row["high_ml"]) for row in rows] == pytest.approx(report["volumes_high_ml"], abs=1e-3)
    assert "ejection fraction" in said and "largest in frame 1" in said
    assert f"({100 * report['ejection_fraction_low']:.1f} to {100 * report['ejection_fraction_high']:.1f})" in said


def stl_volume_ml(path):
    """Of a binary STL, by its triangles alone."""
    corners = numpy.frombuffer(path.read_bytes()[84:], "3<f4,(3,3)<f4,<u2")["f1"].astype(float)
    return numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6e3


def test_each_frame_has_a_surface_in_a_file_of_its_own(tmp_path, cine, contours):
    (tmp_path / "meshes").mkdir()
    said = succeed("segment", contours, "--image", cine, "--output", tmp_path / "masks.nii.gz", "--mesh", tmp_path / "meshes" / "ball.stl",
                   "--volumes", tmp_path / "v.csv")
    assert names(tmp_path / "meshes") == [f"ball_frame_{n}.stl" for n in range(1, FRAMES + 1)]
    assert "ball_frame_1.stl: 8 surfaces" in said
    for row in csv.DictReader((tmp_path / "v.csv").open()):
        volume = stl_volume_ml(tmp_path / "meshes" / f"ball_frame_{row['frame']}.stl")
        assert volume == pytest.approx(float(row["volume_ml"]), rel=0.03)


def png_chunks(path):
    data, at, found = path.read_bytes(), 8, []
    while at < len(data):
        size = int.from_bytes(data[at:at + 4], "big")
        found.append((data[at + 4:at + 8].decode(), data[at + 8:at + 8 + size]))
        at += size + 12
    return found


def test_a_picture_shows_the_curve_and_an_apng_moves(tmp_path, cine, contours):
    word = ["segment", contours, "--image", cine, "--output", tmp_path / "masks.nii.gz", "--picture"]
    succeed(*word, tmp_path / "still.png")
    kinds = [kind for kind, _ in png_chunks(tmp_path / "still.png")]
    assert "acTL" not in kinds and kinds[0] == "IHDR" and kinds[-1] == "IEND"
    said = succeed(*word, tmp_path / "moving.apng")
    assert "moving.apng" in said
    chunks = png_chunks(tmp_path / "moving.apng")
    [control] = [content for kind, content in chunks if kind == "acTL"]
    assert int.from_bytes(control[:4], "big") == FRAMES
    frames = [content for kind, content in chunks if kind == "fcTL"]
    assert len(frames) == FRAMES
    assert [int.from_bytes(frame[20:22], "big") for frame in frames] == [40] * FRAMES  # ms
    numbers = [int.from_bytes(content[:4], "big") for kind, content in chunks if kind in ("fcTL", "fdAT")]
    assert numbers == list(range(len(numbers)))
    still = write(tmp_path / "still.json", ball(1))
    assert "moving.apng would move, and contours are of one moment" in refusal(
        still, "--image", cine, "--frame", 1, "--output", tmp_path / "m.nii.gz", "--picture", tmp_path / "moving.apng")


def test_a_dicom_cine_gets_a_segmentation_with_time_as_a_dimension(tmp_path, beats, contours):
    succeed("segment", contours, "--image", beats, "--output", tmp_path / "masks.nii.gz")
    succeed("segment", contours, "--image", beats, "--output", tmp_path / "masks.dcm", "--name", "Ventricle")
    assert "Error" not in subprocess.run(["dciodvfy", tmp_path / "masks.dcm"], capture_output=True, text=True).stderr
    seg = pydicom.dcmread(tmp_path / "masks.dcm")
    assert [segment.SegmentLabel for segment in seg.SegmentSequence] == ["Ventricle"]
    assert [d.DimensionDescriptionLabel for d in seg.DimensionIndexSequence] == ["segment", "time", "position"]
    assert seg.DimensionIndexSequence[1].DimensionIndexPointer == pydicom.tag.Tag("TemporalPositionIndex")
    sources = {}
    for file in beats.iterdir():
        slice_ = pydicom.dcmread(file, stop_before_pixels=True)
        sources[slice_.SOPInstanceUID] = slice_
    assert len(seg.ReferencedSeriesSequence[0].ReferencedInstanceSequence) == len(sources)
    masks = numpy.asarray(nibabel.load(tmp_path / "masks.nii.gz").dataobj)
    seen = numpy.zeros_like(masks)
    for frame, pixels in zip(seg.PerFrameFunctionalGroupsSequence, seg.pixel_array):
        source = sources[frame.DerivationImageSequence[0].SourceImageSequence[0].ReferencedSOPInstanceUID]
        content = frame.FrameContentSequence[0]
        time, k = content.DimensionIndexValues[1] - 1, content.DimensionIndexValues[2] - 1
        assert content.TemporalPositionIndex == time + 1
        assert abs(float(source.TriggerTime) - 15 - 40 * time) <= 1
        assert frame.PlanePositionSequence[0].ImagePositionPatient == source.ImagePositionPatient
        seen[:, :, k, time] = pixels.T
    assert numpy.array_equal(seen, masks) and masks.any((0, 1, 2)).all()
    result = kontur("convert", tmp_path / "masks.dcm", tmp_path / "one.nii.gz")
    assert result.returncode == 69 and "the segmentation has 8 moments, and one is read" in result.stderr


def test_bytes_do_not_depend_on_threads(tmp_path, cine, contours):
    for threads in (1, 2):
        succeed("segment", contours, "--image", cine, "--output", tmp_path / f"{threads}.nii.gz", "--threads", threads)
    assert (tmp_path / "1.nii.gz").read_bytes() == (tmp_path / "2.nii.gz").read_bytes()


def test_a_cycle_may_be_given_as_an_option_and_times_in_seconds(tmp_path, cine, contours):
    succeed("segment", contours, "--image", cine, "--output", tmp_path / "frames.nii.gz")
    planes = ball(1) + ball(5)
    for plane in planes:
        contour = plane["contours"][0]
        contour["time_s"] = 0.04 * (contour.pop("frame") - 1)
    in_seconds = write(tmp_path / "seconds.json", planes)
    succeed("segment", in_seconds, "--image", cine, "--output", tmp_path / "seconds.nii.gz", "--cycle", 0.32)
    one, other = (numpy.asarray(nibabel.load(tmp_path / f"{name}.nii.gz").dataobj) for name in ("frames", "seconds"))
    assert numpy.array_equal(one, other)
    result = kontur("segment", in_seconds, "--image", cine, "--output", tmp_path / "rest.nii.gz")
    assert result.returncode == 0 and "nothing moves before the first and after the last drawn moment" in result.stderr


def test_volumes_of_a_dicom_series_are_frames_and_its_tags_tell_the_cycle(tmp_path, cine, beats, contours):
    succeed("segment", contours, "--image", cine, "--output", tmp_path / "nifti.nii.gz")
    planes = json.loads(contours.read_text())["planes"]
    unsaid = write(tmp_path / "unsaid.json", planes)
    result = kontur("segment", unsaid, "--image", beats, "--output", tmp_path / "dicom.nii.gz")
    assert result.returncode == 0 and f"the motion repeats after 8 frames, as {beats} says; --cycle says otherwise" in result.stderr
    one, other = (nibabel.load(tmp_path / f"{name}.nii.gz") for name in ("nifti", "dicom"))
    assert numpy.array_equal(numpy.asarray(one.dataobj), numpy.asarray(other.dataobj))
    assert other.header["pixdim"][4] == pytest.approx(0.04) and numpy.abs(one.affine - other.affine).max() < 1e-5
    succeed("segment", unsaid, "--image", beats / "000.dcm", "--cycle", FRAMES, "--output", tmp_path / "file.nii.gz")
    assert (tmp_path / "file.nii.gz").read_bytes() == (tmp_path / "dicom.nii.gz").read_bytes()
    assert "--volume 2 chooses one volume" in refusal(unsaid, "--image", beats, "--volume", 2, "--output", tmp_path / "no.nii.gz")


@pytest.mark.parametrize("kinds", ["domain domain domain list", "list domain domain domain"])
def test_frames_may_be_a_list_of_nrrd(tmp_path, cine, contours, kinds):
    is_first = kinds.startswith("list")
    sizes, steps = ["25"] * 3, ["(1.5,0,0)", "(0,1.5,0)", "(0,0,1.5)"]
    sizes.insert(0 if is_first else 3, str(FRAMES))
    steps.insert(0 if is_first else 3, "none")
    header = (f"NRRD0004\ntype: short\ndimension: 4\nspace: left-posterior-superior\nsizes: {' '.join(sizes)}\nendian: little\n"
              f"space directions: {' '.join(steps)}\nkinds: {kinds}\nencoding: raw\nspace origin: (-18,-18,-18)\n\n")
    (tmp_path / "cine.nrrd").write_bytes(header.encode() + bytes(2 * FRAMES * 25**3))
    succeed("segment", contours, "--image", cine, "--output", tmp_path / "nifti.nii.gz")
    succeed("segment", contours, "--image", tmp_path / "cine.nrrd", "--output", tmp_path / "nrrd.nii.gz")
    one, other = (numpy.asarray(nibabel.load(tmp_path / f"{name}.nii.gz").dataobj) for name in ("nifti", "nrrd"))
    assert numpy.array_equal(one, other) and one.any()


@pytest.fixture(name="files")
def files_fixture(tmp_path, cine):
    """The cine's frames as files of their own, whose names sort otherwise than they count."""
    folder = tmp_path / "files"
    folder.mkdir()
    image = nibabel.load(cine)
    for n in range(FRAMES):
        nibabel.save(nibabel.Nifti1Image(numpy.full((25, 25, 25), n, numpy.int16), image.affine), folder / f"phase {5 * (n + 1)}.nii.gz")
    return folder


def test_frames_may_be_the_files_of_a_folder_in_the_order_of_their_numbers(tmp_path, cine, files, contours):
    succeed("segment", contours, "--image", cine, "--output", tmp_path / "one.nii.gz")
    result = kontur("segment", contours, "--image", files, "--output", tmp_path / "many.nii.gz")
    assert result.returncode == 0, result.stderr
    assert (f"{files}: the 8 frames are files in this order: phase 5.nii.gz to phase 40.nii.gz; nothing says how far apart they"
            " are in time") in result.stderr
    one, other = (numpy.asarray(nibabel.load(tmp_path / f"{name}.nii.gz").dataobj) for name in ("one", "many"))
    assert numpy.array_equal(one, other) and one.any()
    succeed("convert", files, tmp_path / "second.nii.gz", "--frame", 2)
    assert numpy.all(numpy.asarray(nibabel.load(tmp_path / "second.nii.gz").dataobj) == 1), "phase 10, not phase 5 or 15"


def test_what_a_folder_of_frames_cannot_be_is_one_sentence(tmp_path, files, contours):
    output = ("--output", tmp_path / "masks.nii.gz")
    assert "holds 8 images, phase 5.nii.gz to phase 40.nii.gz, the frames of one" in kontur("convert", files, tmp_path / "no.nii.gz").stderr
    assert "has no frame 9; its 8 images are 1 to 8" in kontur("convert", files, tmp_path / "no.nii.gz", "--frame", 9).stderr
    planes = ball(1) + ball(5)
    for plane in planes:
        contour = plane["contours"][0]
        contour["time_s"] = 0.04 * contour.pop("frame")
    assert "does not say how far apart its frames are; give contours a frame" in refusal(write(tmp_path / "s.json", planes), "--image", files, *output)
    odd = nibabel.load(files / "phase 5.nii.gz")
    nibabel.save(nibabel.Nifti1Image(numpy.zeros((25, 25, 24), numpy.int16), odd.affine), files / "phase 12.nii.gz")
    assert "phase 5.nii.gz and phase 12.nii.gz are no frames of one image: they have 25 x 25 x 25 and 25 x 25 x 24 voxels" in refusal(contours, "--image", files, *output)
    shifted = odd.affine.copy()
    shifted[2, 3] += 0.5
    nibabel.save(nibabel.Nifti1Image(numpy.zeros((25, 25, 25), numpy.int16), shifted), files / "phase 12.nii.gz")
    assert "their corners lie 0.5 mm apart, more than 0.002 mm" in refusal(contours, "--image", files, *output)
    nibabel.save(nibabel.Nifti1Image(numpy.zeros((25, 25, 25, 3), numpy.int16), odd.affine), files / "phase 12.nii.gz")
    assert "phase 12.nii.gz has 3 frames itself" in refusal(contours, "--image", files, *output)


def test_series_of_a_folder_are_phases_where_their_names_count_them(tmp_path, cine, contours):
    breath = tmp_path / "breath"
    dicom.write_phases(breath, FRAMES, 25, SPACING, -HALF)
    succeed("segment", contours, "--image", cine, "--output", tmp_path / "nifti.nii.gz")
    unsaid = write(tmp_path / "unsaid.json", json.loads(contours.read_text())["planes"])
    result = kontur("segment", unsaid, "--image", breath, "--output", tmp_path / "dicom.nii.gz")
    assert result.returncode == 0, result.stderr
    assert "the 8 frames are series in this order: 'P4 Gated, 0.0%' to 'P4 Gated, 87.5%'" in result.stderr
    assert f"the motion repeats after 8 frames, as {breath} says; --cycle says otherwise" in result.stderr
    one, other = (numpy.asarray(nibabel.load(tmp_path / f"{name}.nii.gz").dataobj) for name in ("nifti", "dicom"))
    assert numpy.array_equal(one, other) and one.any()
    result = kontur("segment", unsaid, "--image", breath, "--output", tmp_path / "masks.dcm")
    assert result.returncode == 0, result.stderr
    seg = pydicom.dcmread(tmp_path / "masks.dcm")
    uids = {pydicom.dcmread(file, stop_before_pixels=True).SeriesInstanceUID for file in breath.iterdir()}
    assert {series.SeriesInstanceUID for series in seg.ReferencedSeriesSequence} == uids and len(uids) == FRAMES
    assert [len(series.ReferencedInstanceSequence) for series in seg.ReferencedSeriesSequence] == [25] * FRAMES
    for file in breath.iterdir():
        slice_ = pydicom.dcmread(file)
        slice_.SeriesDescription = slice_.SeriesDescription.replace("%", "").replace("P4 Gated, ", "T")
        slice_.save_as(file)
    assert "the folder holds several series; choose one" in refusal(unsaid, "--image", breath, "--output", tmp_path / "no.nii.gz")


@pytest.fixture(name="drawn_in_time")
def drawn_in_time_fixture(tmp_path, beats):
    """Contours on slices in frames 1 and 5, as JSON, and as a structure set for each that refers to that frame's slices."""
    offsets = (-6.0, -1.5, 1.5, 6.0)
    for frame in (1, 5):
        planes = ball(frame, offsets)
        for plane in planes:
            del plane["contours"][0]["frame"]
        write(tmp_path / f"{frame}.json", planes)
        succeed("convert", tmp_path / f"{frame}.json", tmp_path / f"{frame}.dcm", "--image", beats, "--volume", frame)
    return write(tmp_path / "both.json", ball(1, offsets) + ball(5, offsets))


def voxels(path):
    return numpy.asarray(nibabel.load(path).dataobj)


def test_contours_of_a_structure_set_are_of_the_frame_whose_slices_they_refer_to(tmp_path, beats, drawn_in_time):
    def segment(output, *drawn):
        result = kontur("segment", *drawn, "--image", beats, "--output", tmp_path / output)
        assert result.returncode == 0, result.stderr
        return result.stderr

    segment("json.nii.gz", drawn_in_time)
    segment("two.nii.gz", tmp_path / "1.dcm", tmp_path / "5.dcm")
    assert numpy.array_equal(voxels(tmp_path / "two.nii.gz"), voxels(tmp_path / "json.nii.gz"))
    one, other = (pydicom.dcmread(tmp_path / f"{frame}.dcm") for frame in (1, 5))
    contours = one.ROIContourSequence[0].ContourSequence
    assert len(contours) == 4
    for contour in other.ROIContourSequence[0].ContourSequence:
        contours.append(contour)
    one.save_as(tmp_path / "joined.dcm")
    segment("joined.nii.gz", tmp_path / "joined.dcm")
    assert numpy.array_equal(voxels(tmp_path / "joined.nii.gz"), voxels(tmp_path / "json.nii.gz"))
    assert f"all contours refer to frame 5 of {beats}, which is read" in segment("fifth.nii.gz", tmp_path / "5.dcm")
    succeed("convert", tmp_path / "joined.dcm", tmp_path / "again.json", "--image", beats)
    frames = [c["frame"] for plane in json.loads((tmp_path / "again.json").read_text())["planes"] for c in plane["contours"]]
    assert sorted(frames) == [1] * 4 + [5] * 4
    segment("again.nii.gz", tmp_path / "again.json")
    assert numpy.array_equal(voxels(tmp_path / "again.nii.gz"), voxels(tmp_path / "json.nii.gz"))
    assert "is no DICOM series, to whose frames" in kontur(
        "convert", tmp_path / "joined.dcm", tmp_path / "no.json", "--image", tmp_path / "json.nii.gz").stderr
    assert "which is read" in segment("all.nii.gz", tmp_path / "5.dcm", "--all-rois")
    assert numpy.array_equal(voxels(tmp_path / "all.nii.gz"), voxels(tmp_path / "fifth.nii.gz"))
    assert "which is read" not in segment("all.nii.gz", tmp_path / "joined.dcm", "--all-rois")
    assert numpy.array_equal(voxels(tmp_path / "all.nii.gz"), voxels(tmp_path / "json.nii.gz"))
    del contours[0].ContourImageSequence
    one.save_as(tmp_path / "partly.dcm")
    result = kontur("segment", tmp_path / "partly.dcm", "--image", beats, "--volume", 1, "--output", tmp_path / "partly.nii.gz")
    assert result.returncode == 0, "all of one moment where a volume is chosen"
    result = kontur("segment", tmp_path / "partly.dcm", "--image", beats, "--output", tmp_path / "no.nii.gz")
    assert "the series holds several volumes" in result.stderr


@pytest.fixture(name="two_rois")
def two_rois_fixture(tmp_path, drawn_in_time):
    """A ball drawn in frames 1 and 5, a core of half of its size likewise, and what was drawn in frame 1 alone."""
    rois = pydicom.dcmread(tmp_path / "1.dcm")
    other = pydicom.dcmread(tmp_path / "5.dcm")
    still = copy.deepcopy(rois.ROIContourSequence[0])
    rois.ROIContourSequence[0].ContourSequence.extend(other.ROIContourSequence[0].ContourSequence)
    core = copy.deepcopy(rois.ROIContourSequence[0])
    for contour in core.ContourSequence:
        points = numpy.array(contour.ContourData, float).reshape(-1, 3)
        points[:, :2] /= 2
        contour.ContourData = [f"{c:.3f}" for c in points.ravel()]
    for number, (name, roi) in enumerate({"Core": core, "Still": still}.items(), 2):
        roi.ReferencedROINumber = number
        rois.ROIContourSequence.append(roi)
        item = copy.deepcopy(rois.StructureSetROISequence[0])
        item.ROINumber, item.ROIName = number, name
        rois.StructureSetROISequence.append(item)
        observed = copy.deepcopy(rois.RTROIObservationsSequence[0])
        observed.ObservationNumber = observed.ReferencedROINumber = number
        rois.RTROIObservationsSequence.append(observed)
    rois.StructureSetROISequence[0].ROIName = "Ball"
    rois.save_as(tmp_path / "rois.dcm")
    return tmp_path / "rois.dcm"


def test_several_structures_over_time_become_labels_or_segments_of_all_frames(tmp_path, beats, two_rois):
    alone = []
    for number in (1, 2, 3):
        kontur("segment", two_rois, "--roi", number, "--image", beats, "--output", tmp_path / f"{number}.nii.gz")
        mask = voxels(tmp_path / f"{number}.nii.gz") != 0
        alone.append(mask if number < 3 else numpy.repeat(mask[..., None], FRAMES, axis=3))
    rois = ("--roi", "Core", "--roi", "Ball", "--image", beats)
    said = kontur("segment", two_rois, *rois, "--output", tmp_path / "labels.nii.gz", "--report", tmp_path / "report.json", "--threads", 1)
    assert said.returncode == 0, said.stderr
    labels = nibabel.load(tmp_path / "labels.nii.gz")
    assert labels.shape == alone[0].shape and labels.header["pixdim"][4] == pytest.approx(0.04)
    assert labels.get_data_dtype() == numpy.uint8
    assert numpy.array_equal(voxels(tmp_path / "labels.nii.gz"), numpy.where(alone[1], 1, 2 * alone[0]))
    assert f"{(alone[0] & alone[1]).sum()} voxels of 'Ball' lie in 'Core', too" in said.stderr, "counted in all frames"
    assert "2 structures in 8 frames" in said.stdout and "1 Core: largest in frame 1" in said.stdout
    core, ball = json.loads((tmp_path / "report.json").read_text())["structures"]
    assert [core["name"], ball["name"], ball["smallest_frame"]] == ["Core", "Ball", 5]
    assert ball["volumes_ml"][2] == pytest.approx(alone[0][..., 2].sum() * SPACING**3 / 1000)
    kontur("segment", two_rois, *rois, "--output", tmp_path / "again.nii.gz", "--threads", 3)
    assert (tmp_path / "again.nii.gz").read_bytes() == (tmp_path / "labels.nii.gz").read_bytes()
    result = kontur("segment", two_rois, "--all-rois", "--image", beats, "--output", tmp_path / "masks.dcm")
    assert result.returncode == 0 and "Still: drawn in frame 1 alone, and the same in all" in result.stderr, result.stderr
    assert "Error" not in subprocess.run(["dciodvfy", tmp_path / "masks.dcm"], capture_output=True, text=True).stderr
    seg = pydicom.dcmread(tmp_path / "masks.dcm")
    assert [segment.SegmentLabel for segment in seg.SegmentSequence] == ["Ball", "Core", "Still"]
    seen = numpy.zeros((3, *alone[0].shape), bool)
    for frame, pixels in zip(seg.PerFrameFunctionalGroupsSequence, seg.pixel_array):
        segment, time, k = frame.FrameContentSequence[0].DimensionIndexValues
        assert frame.SegmentIdentificationSequence[0].ReferencedSegmentNumber == segment
        seen[segment - 1, :, :, k - 1, time - 1] = pixels.T
    assert numpy.array_equal(seen, alone), "each keeps its voxels"
    for words in (["--together"], ["--rtstruct", tmp_path / "no.dcm"]):
        assert f"{words[0]} is of one moment" in refusal(two_rois, *rois, *words, "--output", tmp_path / "no.nii.gz")
    result = kontur("segment", two_rois, *rois, "--output", tmp_path / "no.nrrd")
    assert result.returncode == 69 and "are written as .nii or .nii.gz" in result.stderr


def test_contours_of_two_frames_of_reference_are_refused_in_one_sentence(tmp_path, beats, drawn_in_time):
    other = pydicom.dcmread(tmp_path / "5.dcm")
    other.ReferencedFrameOfReferenceSequence[0].FrameOfReferenceUID = "1.2.3.4"
    other.StructureSetROISequence[0].ReferencedFrameOfReferenceUID = "1.2.3.4"
    other.save_as(tmp_path / "elsewhere.dcm")
    for command, words in (("segment", ["--output", tmp_path / "masks.nii.gz"]), ("suggest", [])):
        result = kontur(command, tmp_path / "1.dcm", tmp_path / "elsewhere.dcm", "--image", beats, *words)
        assert result.returncode == 65 and result.stderr.count("\n") == 1, result.stderr
        assert "its contours lie in the frame of reference 1.2.3.4, those before in" in result.stderr
    assert not (tmp_path / "masks.nii.gz").exists()


def test_suggest_names_the_frame_that_is_least_sure_and_a_plane_in_it(tmp_path, cine, contours):
    words = ("suggest", contours, "--image", cine, "--planes", 3)
    found = json.loads(succeed(*words, "--json"))["planes"]
    succeed("segment", contours, "--image", cine, "--output", tmp_path / "masks.nii.gz", "--volumes", tmp_path / "v.csv")
    widths = [float(row["high_ml"]) - float(row["low_ml"]) for row in csv.DictReader((tmp_path / "v.csv").open())]
    assert widths[found[0]["frame"] - 1] == max(widths)
    frames = [plane["frame"] for plane in found]
    assert len(set(frames)) == 3 and not {1, 5} & set(frames[:2])
    assert found[0]["normal"] == [0, 0, 1] and found[0]["volume_low_ml"] < found[0]["volume_ml"] < found[0]["volume_high_ml"]
    said = succeed(*words, "--sketch", tmp_path / "next.json")
    assert f"frame {frames[0]}; " in said and said.count("\n") == 3
    sketch = json.loads((tmp_path / "next.json").read_text())
    assert sorted({c["frame"] for plane in sketch["planes"] for c in plane["contours"]}) == sorted(frames)
    assert sketch["cycle_frames"] == FRAMES
    again = kontur("segment", contours, tmp_path / "next.json", "--image", cine, "--output", tmp_path / "again.nii.gz")
    assert again.returncode == 0 and "5 moments drawn" in again.stdout, again.stderr
    assert json.loads(succeed(*words[:4], "--planes", 1, "--skip", 1, "--json"))["planes"][0] == found[1]


def test_trace_and_convert_say_which_frame_contours_are_of(tmp_path, cine, contours):
    succeed("segment", contours, "--image", cine, "--output", tmp_path / "masks.nii.gz")
    for frame in (1, 5):
        succeed("trace", tmp_path / "masks.nii.gz", "--frame", frame, "--output", tmp_path / f"{frame}.json")
        planes = json.loads((tmp_path / f"{frame}.json").read_text())["planes"]
        assert {contour["frame"] for plane in planes for contour in plane["contours"]} == {frame}
    succeed("segment", tmp_path / "1.json", tmp_path / "5.json", "--image", cine, "--cycle", FRAMES, "--output", tmp_path / "again.nii.gz")
    one, other = (numpy.asarray(nibabel.load(tmp_path / f"{name}.nii.gz").dataobj) for name in ("masks", "again"))
    assert 2 * (one & other).sum() / (one.sum() + other.sum()) > 0.95
    masks = nibabel.load(tmp_path / "masks.nii.gz")
    nibabel.save(nibabel.Nifti1Image(numpy.asarray(masks.dataobj)[..., 4], masks.affine), tmp_path / "phase.nii.gz")
    succeed("trace", tmp_path / "phase.nii.gz", "--frame", 5, "--output", tmp_path / "phase.json", "--name", "masks")
    traced, expected = (json.loads((tmp_path / f"{name}.json").read_text()) for name in ("phase", "5"))
    assert traced["planes"] == expected["planes"], "a mask of one phase becomes contours of that frame"
    succeed("convert", tmp_path / "1.json", tmp_path / "third.json", "--frame", 3)
    assert '"frame": 3' in (tmp_path / "third.json").read_text()
    result = kontur("convert", tmp_path / "1.json", tmp_path / "lost.mrk.json")
    assert result.returncode == 0 and "has no room for the frame or time of contours" in result.stderr


def test_a_cohort_has_volumes_of_what_moves(tmp_path, cine, contours):
    (tmp_path / "cases.csv").write_text(f"contours,image,output,volumes\n{contours},{cine},{tmp_path}/out.nii.gz,{tmp_path}/out.csv\n")
    succeed("batch", tmp_path / "cases.csv", "--summary", tmp_path / "summary.json")
    [case] = json.loads((tmp_path / "summary.json").read_text())["cases"]
    assert case["mask"]["volume_ml"] == max(case["volumes_ml"]) > 0
    assert case["ejection_fraction"] == pytest.approx(1 - (radius(5) / radius(1)) ** 3, abs=0.04)
    assert (tmp_path / "out.csv").exists()


def test_inspect_lists_the_frames(contours):
    [facts] = json.loads(succeed("inspect", contours, "--json"))
    assert (facts["frames"], facts["cycle_frames"], facts["problems"]) == ([1, 5], 8, [])


def test_what_cannot_be_is_refused_in_one_sentence_and_leaves_nothing(tmp_path, cine, contours):
    output = ("--output", tmp_path / "masks.nii.gz")
    image = ("--image", cine, *output)
    before = names(tmp_path)
    late = write(tmp_path / "late.json", ball(1) + ball(9))
    assert "contour 5 lies at frame 9, and the image's frames go from 1 to 8" in refusal(late, *image)
    mixed = write(tmp_path / "mixed.json", ball(1) + [circle("z", 0, center=(0, 0, 0))])
    assert "contour 5 has no frame, and contour 1 has one" in refusal(mixed, *image)
    assert "give a 4D --image" in refusal(contours, "--spacing-mm", 2, *output)
    assert "--frame 2 chooses one frame" in refusal(contours, *image, "--frame", 2)
    assert "--uncertainty is of one moment" in refusal(contours, *image, "--uncertainty", tmp_path / "u.nii.gz")
    (tmp_path / "m_frame_3.stl").mkdir()
    result = kontur("segment", contours, *image, "--mesh", tmp_path / "m.stl")
    assert result.returncode == 74 and "m_frame_3.stl" in result.stderr
    (tmp_path / "m_frame_3.stl").rmdir()
    assert "is no DICOM series" in refusal(contours, "--image", cine, "--output", tmp_path / "masks.dcm")
    assert "a cycle of 4 goes from 1 to before 5" in refusal(contours, *image, "--cycle", 4)
    still = write(tmp_path / "still.json", ball(1))
    assert "--cycle is for contours that were drawn at several moments" in refusal(still, *image, "--frame", 1, "--cycle", 8)
    result = kontur("segment", contours, "--image", cine, "--output", tmp_path / "masks.nrrd")
    assert result.returncode == 69 and "are written as .nii or .nii.gz" in result.stderr
    result = kontur("suggest", contours)
    assert result.returncode == 65 and "give a 4D --image" in result.stderr
    result = kontur("suggest", contours, "--image", cine, "--output", tmp_path / "planes.json")
    assert result.returncode == 65 and "--output has no room for frames" in result.stderr
    assert "--cycle is for contours" in kontur("suggest", still, "--cycle", 8).stderr
    assert set(names(tmp_path)) - set(before) == {"late.json", "mixed.json", "still.json"}
