# SPDX-License-Identifier: Apache-2.0
"""make_rtdose.py CASE FOLDER: writes a dose grid (RTDOSE) and what pydicom reads in it.

CASE: "relative" (GridFrameOffsetVector counts from the first plane), "absolute" (from the origin), "descending",
"oblique", "byte" (8 of 16 bits), "single" (planes in files of their own), "two" (grids of one series), or what is wrong:
"irregular", "short" (an offset too few), "unscaled", "neither". FOLDER/dicom holds the files, FOLDER/truth.txt and truth.raw
what make_dicom_series.py puts there, the values in Gy.
"""

import sys
from pathlib import Path

import numpy as np
from pydicom import dcmread
from pydicom.dataset import FileDataset, FileMetaDataset
from pydicom.uid import ImplicitVRLittleEndian, generate_uid

RTDOSE = "1.2.840.10008.5.1.4.1.1.481.2"
NZ, NY, NX = 6, 5, 7
SPACING, STEP = (3.0, 2.5), 4.0  # between rows, between columns; between planes
ORIGIN = np.array([-8.0, -6.0, 40.0])


def new_dose(series, bits):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = RTDOSE, generate_uid()
    meta.TransferSyntaxUID = ImplicitVRLittleEndian
    d = FileDataset("", {}, file_meta=meta, preamble=b"\0" * 128)
    d.is_little_endian, d.is_implicit_VR = True, True
    d.SOPClassUID, d.SOPInstanceUID, d.Modality = RTDOSE, meta.MediaStorageSOPInstanceUID, "RTDOSE"
    d.SeriesInstanceUID, d.FrameOfReferenceUID, d.PatientID = series, "1.2.3", "P1"
    d.Rows, d.Columns, d.SamplesPerPixel, d.PhotometricInterpretation = NY, NX, 1, "MONOCHROME2"
    d.BitsAllocated, d.BitsStored, d.HighBit, d.PixelRepresentation = bits, bits, bits - 1, 0
    d.PixelSpacing, d.SliceThickness = list(SPACING), STEP
    d.DoseUnits, d.DoseType, d.DoseSummationType = "GY", "PHYSICAL", "PLAN"
    d.DoseGridScaling = "3.25e-7" if bits == 32 else "0.0125"
    return d


case, folder = sys.argv[1], Path(sys.argv[2])
files = folder / "dicom"
files.mkdir(parents=True)
bits = 16 if case == "byte" else 32
stored = np.random.default_rng(3).integers(0, 2**12 if bits == 16 else 2**31 + 2**30, (NZ, NY, NX))
row, column = (np.array((0.6, 0.8, 0)), np.array((0, 0, 1.0))) if case == "oblique" else (np.array((1.0, 0, 0)), np.array((0, 1.0, 0)))
normal = np.cross(row, column)
heights = STEP * np.arange(NZ)
if case == "irregular":
    heights[3] += 1.5
if case == "descending":
    heights = -heights
series = generate_uid()


def place(d, position):
    d.ImageOrientationPatient, d.ImagePositionPatient = [*map(float, row), *map(float, column)], [*map(float, position)]


def save(d, name, values):
    d.PixelData = np.ascontiguousarray(values).astype(f"<u{bits // 8}").tobytes()
    d["PixelData"].VR = "OW"
    d.save_as(files / name, write_like_original=False)


scaling = 1.0
if case == "single":
    for k in range(NZ):
        d = new_dose(series, bits)
        place(d, ORIGIN + heights[k] * normal)
        save(d, f"plane{k}.dcm", stored[k])
else:
    for number in range(2 if case == "two" else 1):
        d = new_dose(series, bits)
        place(d, ORIGIN)
        d.NumberOfFrames, d.FrameIncrementPointer = NZ, 0x3004000C
        offsets = heights + (ORIGIN[2] if case == "absolute" else 1.25 if case == "neither" else 0)
        d.GridFrameOffsetVector = [float(h) for h in (offsets[:-1] if case == "short" else offsets)]
        if case == "unscaled":
            del d.DoseGridScaling
        save(d, f"dose{number}.dcm", stored + number)
read = [dcmread(path) for path in sorted(files.iterdir())]
if case != "unscaled":
    pixels = np.stack([d.pixel_array for d in read]) if case == "single" else read[0].pixel_array
    truth = pixels * float(read[0].DoseGridScaling)
    lowest = ORIGIN
    if case == "descending":  # kontur's slices ascend along the normal
        truth, lowest = truth[::-1], ORIGIN + heights[-1] * normal
    affine = np.column_stack([row * SPACING[1], column * SPACING[0], STEP * normal, lowest])
    lines = [f"{NX} {NY} {NZ}"] + [" ".join(repr(float(v)) for v in line) for line in affine]
    (folder / "truth.txt").write_text("\n".join(lines) + "\n")
    (folder / "truth.raw").write_bytes(truth.astype("<f8").tobytes())
