# SPDX-License-Identifier: Apache-2.0
"""The files that pages take for granted: small ones of the phantom's liver, under the names that the pages use."""
import pathlib
import shutil
import subprocess

import kontur
import numpy

CASE = kontur.phantom_case("liver_orthogonal14")
GRID = kontur.grid_around(CASE.contours.bounding_box, [4, 4, 4], 16)


def write_dicom(folder, image):
    """As a CT series in axial slices."""
    import pydicom

    folder.mkdir(parents=True)
    grid = image.grid
    series = pydicom.uid.generate_uid(entropy_srcs=["kontur's documentation"])
    for k, samples in enumerate(image.samples):
        meta = pydicom.dataset.FileMetaDataset()
        meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
        meta.MediaStorageSOPInstanceUID = f"{series[:50]}.{k + 1}"
        meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
        one = pydicom.dataset.FileDataset("", {}, file_meta=meta, preamble=bytes(128))
        one.is_little_endian, one.is_implicit_VR = True, False
        one.SOPClassUID, one.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
        one.SeriesInstanceUID, one.StudyInstanceUID, one.FrameOfReferenceUID = series, "1.2", "1.2.4"
        one.Modality, one.PatientName, one.PatientID = "CT", "Phantom^One", "P1"
        one.Rows, one.Columns = samples.shape
        one.PixelSpacing = [float(grid.spacing_mm[1]), float(grid.spacing_mm[0])]
        one.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
        one.ImagePositionPatient = [f"{x:.6f}" for x in (grid.index_to_mm @ [0, 0, k, 1])[:3]]
        one.SamplesPerPixel, one.PhotometricInterpretation = 1, "MONOCHROME2"
        one.BitsAllocated = one.BitsStored = 16
        one.HighBit, one.PixelRepresentation, one.RescaleSlope, one.RescaleIntercept = 15, 1, 1, 0
        one.PixelData = samples.astype("<i2").tobytes()
        one.save_as(folder / f"{k:03}.dcm", write_like_original=False)


def write_beating_ball(folder):
    """A cine of 8 frames, and circles on a ball in the first and the fifth of them."""
    import nibabel

    cine = nibabel.Nifti1Image(numpy.zeros((24, 24, 24, 8), numpy.int16), numpy.diag([2, 2, 2, 1]))
    cine.set_sform(cine.affine, 1)
    cine.header.set_xyzt_units("mm", "msec")
    cine.header["pixdim"][4] = 100
    nibabel.save(cine, folder / "cine.nii.gz")
    angles = numpy.linspace(0, 2 * numpy.pi, 48, endpoint=False)
    drawn = []
    for frame, radius in ((1, 18), (5, 14)):
        for z in (-10, -3, 3, 10):
            r = numpy.sqrt(radius**2 - z**2)
            ring = numpy.c_[r * numpy.cos(angles) - 23, r * numpy.sin(angles) - 23, 0 * angles + z + 23]
            drawn.append(kontur.Contour(ring, frame=frame))
    kontur.write_contours(folder / "beating.json", kontur.ContourSet(drawn, name="ball", cycle_frames=8))


def write_material(folder):
    image = kontur.make_phantom_image(GRID)
    truth = kontur.make_truth_mask(CASE.body, GRID)
    for name in ("demo", "out", "P001", "P002"):
        (folder / name).mkdir()
    for name in ("ct.nii.gz", "pet.nii.gz", "demo/liver_ct.nii.gz", "P001/ct.nii.gz"):
        kontur.write_image(folder / name, image)
    for name in ("truth.nii.gz", "demo/liver_truth_liver.nii.gz"):
        kontur.write_mask(folder / name, truth)
    kontur.write_mask(folder / "organs.nii.gz", truth, label_value=3)
    painted = truth.values.copy()
    painted[numpy.arange(len(painted)) % 5 != 2] = 0
    kontur.write_mask(folder / "sparse.nii.gz", kontur.Mask(painted, GRID), label_value=3)
    for name in ("contours.json", "planes.json", "demo/liver_orthogonal14.json", "P001/liver.json"):
        kontur.write_contours(folder / name, CASE.contours)
    kontur.write_contours(folder / "curves.mrk.json", CASE.contours)
    kontur.write_contours(folder / "corrections.json", kontur.ContourSet(CASE.contours[:1]))
    axial = [c for c in CASE.contours if abs(c.plane.normal[2]) > 0.9]
    others = [c for c in CASE.contours if abs(c.plane.normal[2]) <= 0.9]
    for name, some in (("axial", axial), ("sagittal", others)):
        kontur.write_contours(folder / "P002" / f"{name}.json", kontur.ContourSet(some, name="liver"))
    write_beating_ball(folder)
    write_dicom(folder / "dicom_folder", image)
    shutil.copytree(folder / "dicom_folder", folder / "P002" / "dicom")
    liver = kontur.segment(CASE.contours, GRID, mesh=True)
    for name in ("liver.nii.gz", "tumour.nii.gz"):
        kontur.write_mask(folder / name, liver.mask)
    kontur.write_mesh(folder / "liver.stl", liver.mesh)
    wrapper = pathlib.Path(__file__).parent / "kontur"
    subprocess.run([wrapper, "open", folder / "ct.nii.gz", "--project", folder / "work.kontur"], check=True, capture_output=True)
