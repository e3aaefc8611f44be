# SPDX-License-Identifier: Apache-2.0
"""Where a voxel lies is what nibabel and pydicom say, at every corner to 1e-6 mm: all 48 orientations of the axes, oblique, sheared and
left-handed ones, both forms of NIfTI and their disagreement."""
import itertools
import pathlib
import sys

import nibabel
import numpy
import pydicom
import pytest
from support import kontur, succeed

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
import image_oracle  # noqa: E402

RAS = numpy.diag([-1.0, -1.0, 1.0, 1.0])
SHAPE, SPACING, ORIGIN = (4, 3, 2), (0.7, 1.3, 2.5), (-123.4, 56.7, -1890.1)
VALUES = numpy.arange(24, dtype=numpy.int16).reshape(SHAPE)


def orientations():
    """Signed permutations: 24 right-handed, 24 left-handed."""
    for permutation in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            yield numpy.eye(3)[:, permutation] * signs


def rotation(seed):
    q, _ = numpy.linalg.qr(numpy.random.default_rng(seed).normal(size=(3, 3)))
    return q * numpy.sign(numpy.linalg.det(q))


OBLIQUE = [rotation(n) @ numpy.diag([1, 1, hand]) for n in range(6) for hand in (1, -1)]
SHEARED = [rotation(n) @ numpy.array([[1, 0.1, 0], [0, 1, 0.3], [0, 0, 1]]) for n in range(4)]


def affine_of(directions):
    affine = numpy.eye(4)
    affine[:3, :3] = directions * SPACING
    affine[:3, 3] = ORIGIN
    return affine


def read_back(folder, source, *words):
    """Affine (LPS) and voxels as kontur understood the file, in a plain format read by a parser of the tests."""
    out = folder / "out.nrrd"
    succeed("convert", source, out, *words)
    return image_oracle.read_nrrd(out)


def assert_same(found, affine, values):
    assert image_oracle.corner_distance(values.shape, found[0], affine) < 1e-6
    numpy.testing.assert_array_equal(found[1], values)


def nifti(path, sform=None, qform=None, kind=nibabel.Nifti1Image):
    image = kind(VALUES, None)
    image.header.set_xyzt_units("mm")
    if sform is not None:
        image.header.set_sform(RAS @ affine_of(sform), 1)
    if qform is not None:
        image.header.set_qform(RAS @ affine_of(qform), 1)
    nibabel.save(image, path)
    return nibabel.load(path)


def affine_by_nibabel(saved):
    """In RAS. Half a turn is what the format's reference code makes of a quaternion within 1e-7 of it: where it has lost its real part
    to 32 bits, nibabel turns by up to 0.03 degrees instead."""
    header = saved.header
    vector = numpy.array([float(header[f"quatern_{letter}"]) for letter in "bcd"])
    if int(header["sform_code"]) > 0 or 1 - vector @ vector >= 1e-7:
        return saved.affine
    affine = numpy.eye(4)
    scale = header["pixdim"][1:4].astype(float) * [1, 1, float(header["pixdim"][0])]
    affine[:3, :3] = nibabel.quaternions.quat2mat([0, *(vector / numpy.linalg.norm(vector))]) * scale
    affine[:3, 3] = [float(header[f"qoffset_{axis}"]) for axis in "xyz"]
    return affine


@pytest.mark.parametrize("form", ["sform", "qform"])
def test_nifti_in_every_orientation_is_nibabels(tmp_path, form):
    for number, directions in enumerate([*orientations(), *OBLIQUE, *(SHEARED if form == "sform" else [])]):
        path = tmp_path / f"{number}.nii"
        saved = nifti(path, **{form: directions}, kind=nibabel.Nifti2Image if number % 2 else nibabel.Nifti1Image)
        assert_same(read_back(tmp_path, path), RAS @ affine_by_nibabel(saved), VALUES)


def test_nifti_forms_that_disagree_need_a_choice_and_then_are_nibabels(tmp_path):
    path = tmp_path / "both.nii"
    saved = nifti(path, sform=OBLIQUE[0], qform=OBLIQUE[2])
    refused = kontur("convert", path, tmp_path / "out.nrrd")
    assert refused.returncode == 69 and "sform and qform differ" in refused.stderr
    assert_same(read_back(tmp_path, path, "--prefer", "sform"), RAS @ saved.get_sform(), VALUES)
    assert_same(read_back(tmp_path, path, "--prefer", "qform"), RAS @ saved.get_qform(), VALUES)


def test_nifti_forms_that_agree_need_none(tmp_path):
    path = tmp_path / "both.nii"
    saved = nifti(path, sform=OBLIQUE[1], qform=OBLIQUE[1])
    assert_same(read_back(tmp_path, path), RAS @ saved.get_sform(), VALUES)


def test_nifti_without_a_form_is_refused(tmp_path):
    nifti(tmp_path / "none.nii")
    refused = kontur("convert", tmp_path / "none.nii", tmp_path / "out.nrrd")
    assert refused.returncode == 69 and "how it lies in the patient" in refused.stderr


def test_what_is_written_in_every_orientation_is_read_by_nibabel(tmp_path):
    """From NRRD, which holds the affine as it is, to both versions of NIfTI's geometry."""
    for directions in [*orientations(), *OBLIQUE, *SHEARED]:
        source = tmp_path / "in.nrrd"
        source.write_bytes(image_oracle.nrrd_text(VALUES, affine_of(directions), "raw", "<").encode() + b"\n" + VALUES.astype("<i2").tobytes(order="F"))
        succeed("convert", source, tmp_path / "out.nii")
        saved = nibabel.load(tmp_path / "out.nii")
        # The file holds 32-bit floats: 2e-4 mm at two metres.
        assert image_oracle.corner_distance(SHAPE, RAS @ saved.affine, affine_of(directions)) < 3e-4
        numpy.testing.assert_array_equal(numpy.asanyarray(saved.dataobj), VALUES)


def dicom_series(folder, directions, shear=0.0):
    """Slices along the third direction as DICOM has them; returns what pydicom reads: affine and values."""
    folder.mkdir()
    uid = pydicom.uid.generate_uid()
    for k in range(SHAPE[2]):
        meta = pydicom.dataset.FileMetaDataset()
        meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = "1.2.840.10008.5.1.4.1.1.2", pydicom.uid.generate_uid()
        meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
        d = pydicom.dataset.FileDataset("", {}, file_meta=meta, preamble=bytes(128))
        d.is_little_endian, d.is_implicit_VR = True, False
        d.SOPClassUID, d.SOPInstanceUID, d.Modality = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID, "CT"
        d.SeriesInstanceUID = d.StudyInstanceUID = d.FrameOfReferenceUID = uid
        d.Rows, d.Columns, d.PixelSpacing, d.SliceThickness = SHAPE[1], SHAPE[0], [SPACING[1], SPACING[0]], SPACING[2]
        d.ImageOrientationPatient = [f"{v:.12g}" for v in (*directions[:, 0], *directions[:, 1])]
        step = SPACING[2] * (directions[:, 2] + shear * directions[:, 1])
        d.ImagePositionPatient = [f"{v:.12g}" for v in numpy.array(ORIGIN) + k * step]
        d.SamplesPerPixel, d.PhotometricInterpretation = 1, "MONOCHROME2"
        d.BitsAllocated, d.BitsStored, d.HighBit, d.PixelRepresentation = 16, 16, 15, 1
        d.PixelData = VALUES[:, :, k].T.astype("<i2").tobytes()
        d.save_as(folder / f"{k}.dcm", write_like_original=False)
    slices = [pydicom.dcmread(folder / f"{k}.dcm") for k in range(SHAPE[2])]
    row, column = (numpy.array(slices[0].ImageOrientationPatient[n : n + 3], float) for n in (0, 3))
    positions = [numpy.array(s.ImagePositionPatient, float) for s in slices]
    affine = numpy.eye(4)
    affine[:3, :3] = numpy.column_stack([row * SPACING[0], column * SPACING[1], positions[1] - positions[0]])
    affine[:3, 3] = positions[0]
    return affine, numpy.stack([s.pixel_array.T for s in slices], -1)


def test_dicom_in_every_orientation_is_pydicoms(tmp_path):
    right_handed = [d for d in [*orientations(), *OBLIQUE] if numpy.linalg.det(d) > 0]
    assert len(right_handed) == 30
    for number, directions in enumerate(right_handed):
        affine, values = dicom_series(tmp_path / f"{number}", directions)
        assert_same(read_back(tmp_path, tmp_path / f"{number}"), affine, values)


def test_dicom_slices_in_descending_order_come_out_ascending(tmp_path):
    """A left-handed stack is the right-handed one counted from its other end: no voxel moves."""
    for number, directions in enumerate(d for d in orientations() if numpy.linalg.det(d) < 0):
        affine, values = dicom_series(tmp_path / f"{number}", directions)
        turned = affine.copy()
        turned[:3, 3] = affine[:3, 3] + affine[:3, 2]
        turned[:3, 2] = -affine[:3, 2]
        assert_same(read_back(tmp_path, tmp_path / f"{number}"), turned, values[:, :, ::-1])


def test_a_gantry_tilt_stays_the_shear_that_it_is(tmp_path):
    affine, values = dicom_series(tmp_path / "tilt", rotation(3), shear=numpy.tan(numpy.radians(15)))
    result = kontur("convert", tmp_path / "tilt", tmp_path / "out.nrrd")
    assert result.returncode == 0 and "tilt" in result.stderr
    assert_same(image_oracle.read_nrrd(tmp_path / "out.nrrd"), affine, values)
