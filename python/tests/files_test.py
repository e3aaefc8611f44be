# SPDX-License-Identifier: Apache-2.0
"""Readers and writers; the formats themselves are tested in C++."""
import json
import logging

import kontur
import numpy
import pytest


@pytest.mark.parametrize("name", ["a.nii", "a.nii.gz", "a.nrrd", "a.mha", "a.mgz"])
def test_images_come_back(tmp_path, oblique, name):
    image = kontur.Image(numpy.arange(60, dtype="i2").reshape(oblique.shape) - 30, oblique)
    kontur.write_image(tmp_path / name, image)
    back = kontur.read_image(str(tmp_path / name))
    assert back.samples.dtype == "int16"
    assert numpy.array_equal(back.samples, image.samples)
    assert kontur.corner_distance_mm(back.grid, oblique) < 1e-4
    assert kontur.read_grid(tmp_path / name) == back.grid


def test_masks_come_back_by_label(tmp_path, oblique):
    mask = kontur.Mask(numpy.arange(60).reshape(oblique.shape) % 3 > 0, oblique)
    kontur.write_mask(tmp_path / "a.seg.nrrd", mask, label_value=7, segment_name="left kidney")
    assert numpy.array_equal(kontur.read_mask(tmp_path / "a.seg.nrrd", label=7).values, mask.values)
    assert b"Segment0_Name:=left kidney" in (tmp_path / "a.seg.nrrd").read_bytes()
    with pytest.raises(kontur.InvalidInputError, match="no label 8"):
        kontur.read_mask(tmp_path / "a.seg.nrrd", label=8)


def test_contours_come_back(tmp_path, case):
    kontur.write_contours(tmp_path / "a.json", case.contours)
    assert kontur.read_contours(tmp_path / "a.json") == kontur.read_contour_json(tmp_path / "a.json") == case.contours
    assert len(kontur.read_planes_json(tmp_path / "a.json")) == 6
    kontur.write_contours(tmp_path / "a.mrk.json", case.contours)
    curves = kontur.read_contours(tmp_path / "a.mrk.json", plane_tolerance_mm=0.01)
    assert curves.point_count == case.contours.point_count
    told = kontur.ContourSet(
        case.contours.contours, "kidney",
        attributes=kontur.StructureAttributes(color=(1, 2, 255), interpreted_type="ORGAN", number=3, code=kontur.CodedConcept("64033007", "SCT", "Kidney")),
    )
    kontur.write_contours(tmp_path / "told.json", told)
    assert kontur.read_contours(tmp_path / "told.json") == told
    roi = kontur.Roi(told, interpreted_type="AVOIDANCE")
    assert (roi.color, roi.interpreted_type, roi.contours.attributes.code) == ([1, 2, 255], "AVOIDANCE", told.attributes.code)
    several = kontur.StructureSet([kontur.Roi(told, number=4), kontur.Roi(told, number=9)])
    for number in (9, numpy.int64(9), "9"):
        assert kontur.select_roi(several, number).number == 9
    with pytest.raises(kontur.InvalidInputError, match="there is no ROI '5'"):
        kontur.select_roi(several, 5)
    with pytest.raises(TypeError):
        kontur.StructureAttributes(color=(0, 0, 256))
    both = kontur.read_contours([tmp_path / "a.json", tmp_path / "a.mrk.json"])
    assert len(both) == 12


def test_3d_slicers_curves_are_splines_or_polygons(tmp_path):
    schema = "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/markups-schema-v1.0.3.json#"
    points = [{"position": [20 * numpy.cos(a), 20 * numpy.sin(a), 0.0]} for a in numpy.arange(6) * numpy.pi / 3]
    path = tmp_path / "ring.mrk.json"
    path.write_text(json.dumps({"@schema": schema, "markups": [{"type": "ClosedCurve", "controlPoints": points}]}))
    notes = []
    drawn = kontur.read_contours(path, on_note=notes.append)
    assert drawn.point_count > 30 and "1 curve as the spline that 3D Slicer draws" in notes[0]
    assert kontur.read_contours(path, curves="spline", on_note=notes.append) == drawn
    notes.clear()
    straight = kontur.read_contours(path, curves="polygon", on_note=notes.append)
    assert straight.point_count == 6 and notes == []
    with pytest.raises(ValueError, match="'bezier' is none of"):
        kontur.read_contours(path, curves="bezier")


READERS = [kontur.read_contours, kontur.read_contour_json, kontur.read_planes_json, kontur.read_mesh, kontur.read_provenance,
           kontur.read_image, kontur.read_grid, kontur.read_mask, kontur.read_rtstruct, kontur.list_dicom_series, kontur.read_dicom_slice,
           kontur.read_dicom_grid, kontur.read_dicom_series, kontur.read_dicom_seg, kontur.read_dicom_seg_masks,
           kontur.read_dicom_segmentation]


@pytest.mark.parametrize("read", READERS, ids=lambda read: read.__name__)
def test_a_missing_file_is_pythons_own_error_and_konturs(tmp_path, read):
    with pytest.raises(FileNotFoundError, match=r"^cannot read \S+none\.nii: No such file or directory$") as caught:
        read(tmp_path / "none.nii")
    assert isinstance(caught.value, kontur.FileError) and caught.value.kind == "io"


def test_of_several_files_the_missing_one_is_named(tmp_path, case):
    kontur.write_contours(tmp_path / "a.json", case.contours)
    with pytest.raises(kontur.MissingFileError, match="b.json"):
        kontur.read_contours([tmp_path / "a.json", tmp_path / "b.json"])


@pytest.mark.parametrize("name", ["a.stl", "a.ply", "a.obj", "a.vtk", "a.vtp"])
def test_meshes_come_back(tmp_path, kidney, name):
    kontur.write_mesh(tmp_path / name, kidney.mesh)
    back = kontur.read_mesh(tmp_path / name)
    assert len(back.triangles) == len(kidney.mesh.triangles)
    assert kontur.signed_volume_mm3(back) == pytest.approx(kontur.signed_volume_mm3(kidney.mesh), rel=1e-5)


def make_series(folder, grid):
    """A CT series of `grid`, whose axes must be the patient's."""
    pydicom = pytest.importorskip("pydicom")
    for k in range(grid.size[2]):
        meta = pydicom.dataset.FileMetaDataset()
        meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
        meta.MediaStorageSOPInstanceUID = f"1.2.3.{k + 1}"
        meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
        slice_ = pydicom.dataset.FileDataset("", {}, file_meta=meta, preamble=bytes(128))
        slice_.is_little_endian, slice_.is_implicit_VR = True, False
        slice_.SOPClassUID, slice_.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
        slice_.SeriesInstanceUID, slice_.StudyInstanceUID, slice_.FrameOfReferenceUID = "1.2.3", "1.2", "1.2.4"
        slice_.Modality, slice_.SeriesDescription, slice_.PatientID = "CT", "phantom", "p"
        slice_.Rows, slice_.Columns = grid.size[1], grid.size[0]
        slice_.PixelSpacing = [float(grid.spacing_mm[1]), float(grid.spacing_mm[0])]
        slice_.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
        slice_.ImagePositionPatient = [float(x) for x in (grid.index_to_mm @ [0, 0, k, 1])[:3]]
        slice_.SamplesPerPixel, slice_.PhotometricInterpretation = 1, "MONOCHROME2"
        slice_.BitsAllocated = slice_.BitsStored = 16
        slice_.HighBit, slice_.PixelRepresentation = 15, 1
        slice_.RescaleSlope, slice_.RescaleIntercept = 1, -1024
        slice_.PixelData = numpy.full((grid.size[1], grid.size[0]), k, "<i2").tobytes()
        slice_.save_as(folder / f"{k}.dcm", write_like_original=False)


def test_a_dicom_series(tmp_path):
    grid = kontur.Grid((4, 3, 5), numpy.diag([0.5, 0.5, 2, 1]), frame="LPS")
    make_series(tmp_path, grid)
    [series] = kontur.list_dicom_series(tmp_path)
    assert (series.modality, series.description, len(series.files), series.rows) == ("CT", "phantom", 5, 3)
    volume = kontur.read_dicom_series(tmp_path, series_uid="1.2.3")
    assert volume.image.grid == kontur.read_dicom_grid(tmp_path).grid == grid
    assert volume.image.samples[:, 0, 0].tolist() == [-1024, -1023, -1022, -1021, -1020]
    assert numpy.array_equal(kontur.read_image(tmp_path).samples, volume.image.samples)
    one = kontur.read_dicom_slice(series.files[2])
    assert one.grid.size == (4, 3, 1) and numpy.array_equal(one.samples[0], volume.image.samples[2])
    with pytest.raises(kontur.InvalidInputError, match="has no frame 2; it has 1 to 1"):
        kontur.read_dicom_slice(series.files[2], frame=2)
    with pytest.raises(kontur.InvalidInputError):
        kontur.read_image(tmp_path, series_uid="9.9")


def test_segments_that_overlap_keep_every_voxel(tmp_path):
    grid = kontur.Grid((4, 3, 5), numpy.diag([0.5, 0.5, 2, 1]), frame="LPS")
    (tmp_path / "ct").mkdir()
    make_series(tmp_path / "ct", grid)
    [series] = kontur.list_dicom_series(tmp_path / "ct")
    arrays = numpy.random.default_rng(1).random((2, 5, 3, 4)) < 0.5
    segments = [kontur.DicomSegment(label=name) for name in ("organ", "lesion")]
    kontur.write_dicom_seg_masks(tmp_path / "seg.dcm", [kontur.Mask(a, grid) for a in arrays], segments, series)
    for mask, array in zip(kontur.read_dicom_seg_masks(tmp_path / "seg.dcm"), arrays, strict=True):
        assert numpy.array_equal(mask.values.astype(bool), array)
    about = kontur.read_dicom_segmentation(tmp_path / "seg.dcm")
    assert [s.shared_voxels for s in about.segments] == [int(arrays.all(axis=0).sum())] * 2 and about.notes
    with pytest.raises(kontur.InvalidInputError, match="'organ' and 2 'lesion' overlap"):
        kontur.read_dicom_seg(tmp_path / "seg.dcm")


def test_notes_go_to_the_caller_or_to_the_log(tmp_path, caplog):
    make_series(tmp_path, kontur.Grid((4, 3, 5), numpy.diag([0.5, 0.5, 2, 1]), frame="LPS"))
    (tmp_path / "readme.txt").write_text("no image")
    notes = []
    kontur.read_image(tmp_path, on_note=notes.append)
    assert not caplog.records
    with caplog.at_level(logging.WARNING, "kontur"):
        kontur.read_image(tmp_path)
    assert notes and [record.getMessage() for record in caplog.records] == notes


def test_a_slice_that_may_be_missing_is_told_and_one_that_may_not_be_read_is_an_error(tmp_path, caplog):
    make_series(tmp_path, kontur.Grid((4, 3, 5), numpy.diag([0.5, 0.5, 2, 1]), frame="LPS"))
    (tmp_path / "4.dcm").write_bytes(b"")
    warning = "left out 1 file, named like the slices but no DICOM: 4.dcm (0 bytes); the volume may lack a slice"
    assert kontur.read_image(tmp_path).samples.shape[0] == 4
    assert [record.getMessage() for record in caplog.records] == [warning]
    assert kontur.read_dicom_series(tmp_path).warnings == kontur.read_dicom_grid(tmp_path).warnings == [warning]
    (tmp_path / "4.dcm").unlink()
    (tmp_path / "4.dcm").symlink_to("/proc/self/mem")  # a regular file of which nobody may read the first byte
    for read in (kontur.read_image, kontur.read_grid, kontur.read_dicom_series, kontur.list_dicom_series):
        with pytest.raises(kontur.FileError, match="cannot read .*4.dcm"):
            read(tmp_path)


def test_a_picture(tmp_path, case, kidney):
    pixels = kontur.make_picture(kidney.mesh, case.contours, width_px=400, height_px=250, facts=[("Made by", "a test")])
    assert (pixels.shape, pixels.dtype) == ((250, 400, 3), numpy.uint8)
    assert len(numpy.unique(pixels.reshape(-1, 3), axis=0)) > 50
    kontur.write_png(tmp_path / "a.png", pixels)
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(kontur.InvalidInputError):
        kontur.make_picture(kidney.mesh, case.contours, width_px=10)


def test_reslice_outline_and_window(case, kidney):
    image = kontur.make_phantom_image(kontur.grid_around(case.contours.bounding_box, [3, 3, 3], 10), noise_hu=0)
    centre = case.contours.bounding_box.mean(0)
    plane = kontur.Plane(centre, [0, 0, 1], u=[1, 0, 0], v=[0, 1, 0])
    raster = kontur.reslice(image, plane, 9, 7, pixel_mm=2, outside=-2000)
    assert (raster.shape, raster.dtype) == ((7, 9), numpy.float32)
    points = centre + [[2 * (c - 4), 2 * (r - 3), 0] for r in range(7) for c in range(9)]
    assert numpy.allclose(raster.ravel(), kontur.interpolate(image, points, outside=-2000), atol=1e-3)
    centre_hu, width_hu = kontur.suggest_window(image)
    assert image.samples.min() < centre_hu < image.samples.max() and width_hu > 0
    lines = kontur.outline(kidney.mesh, plane)
    assert lines and all(closed and abs(plane.distance_to(points)).max() < 1e-9 for points, closed in lines)


def test_what_3d_slicer_says_of_segments_is_written(tmp_path):
    grid = kontur.Grid((4, 3, 2), numpy.eye(4), "LPS")
    tags = "TerminologyEntry:A~SCT^123037004^Anatomical Structure~SCT^10200004^Liver~^^~B~^^~^^|"
    labels = kontur.Image(numpy.arange(24, dtype="float32").reshape(2, 3, 4) % 3, grid)
    kontur.write_image(tmp_path / "a.seg.nrrd", labels, label_names={1: "liver", 2: "cyst"}, label_tags={1: tags})
    header = (tmp_path / "a.seg.nrrd").read_bytes()
    assert b"type: uint8" in header and f"Segment0_Tags:={tags}\n".encode() in header and b"Segment1_Tags:=\n" in header
    kontur.write_mask(tmp_path / "b.seg.nrrd", kontur.Mask(numpy.ones((2, 3, 4)), grid), segment_tags=tags)
    assert f"Segment0_Tags:={tags}\n".encode() in (tmp_path / "b.seg.nrrd").read_bytes()
