# SPDX-License-Identifier: Apache-2.0
"""make_dicom_seg.py CASE FILE TRUTH: writes a DICOM segmentation of two segments on 6 slices of 7 x 5 pixels.

CASE: "shuffled" (frames in no order, those without voxels left out), "overlapping", "fractional" ("fractional_0",
"fractional_1000": with that MaximumFractionalValue), "halved" (half of the true spacing is declared, "hair": 1/100 mm, with
frames 0.3 mm off), or what is wrong: "irregular", "turned", "unlisted", "short", "kind". TRUTH gets the label map that it shows (uint8, i fastest); of
overlapping ones, segment 1 is in front, and the mask of segment 4 follows.
"""

import random
import sys

import numpy as np
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.sequence import Sequence
from pydicom.uid import ExplicitVRLittleEndian, generate_uid

case, path, truth_path = sys.argv[1:]
NZ, NY, NX = 6, 5, 7
SPACING = {"halved": 1, "hair": 0.013}
rng = np.random.default_rng(5)
masks = {1: rng.random((NZ, NY, NX)) < 0.3, 4: rng.random((NZ, NY, NX)) < 0.3}
if case != "overlapping":
    masks[4] &= ~masks[1]
for mask in masks.values():
    mask[2] = False  # a slice without a frame
masks[4][4] = False


def of(**values):
    item = Dataset()
    for word, value in values.items():
        setattr(item, word, value)
    return item


meta = FileMetaDataset()
meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = "1.2.840.10008.5.1.4.1.1.66.4", generate_uid()
meta.TransferSyntaxUID = ExplicitVRLittleEndian
d = FileDataset("", {}, file_meta=meta, preamble=b"\0" * 128)
d.is_little_endian, d.is_implicit_VR = True, False
d.SOPClassUID, d.SOPInstanceUID, d.Modality = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID, "SEG"
d.SpecificCharacterSet = "ISO_IR 192"
d.FrameOfReferenceUID = "1.2.3"
d.Rows, d.Columns, d.SamplesPerPixel, d.PhotometricInterpretation = NY, NX, 1, "MONOCHROME2"
d.PixelRepresentation = 0
fractional = case.startswith("fractional")
d.SegmentationType = "FRACTIONAL" if fractional else "LABELMAP" if case == "kind" else "BINARY"
d.BitsAllocated = d.BitsStored = 8 if fractional else 1
d.HighBit = d.BitsStored - 1
if fractional:
    d.MaximumFractionalValue = int(case.partition("_")[2] or 200)
d.SegmentSequence = Sequence(
    [of(SegmentNumber=n, SegmentLabel=name, SegmentAlgorithmType="MANUAL") for n, name in [(1, "Läsion"), (4, "node")]]
)
d.SharedFunctionalGroupsSequence = Sequence(
    [
        of(
            PlaneOrientationSequence=Sequence([of(ImageOrientationPatient=[0.6, 0.8, 0, 0, 0, 1])]),
            PixelMeasuresSequence=Sequence([of(PixelSpacing=[0.5, 0.7], SliceThickness=9, SpacingBetweenSlices=SPACING.get(case, 2))]),
        )
    ]
)
normal = np.array([0.8, -0.6, 0])
frames = [(number, k) for number, mask in masks.items() for k in range(NZ) if mask[k].any()]
random.Random(3).shuffle(frames)
items, pixels = [], []
for n, (number, k) in enumerate(frames):
    height = 2 * k + (0.3 if case in ("irregular", "hair") and n == 0 else 2e19 if case == "far" and n == 0 else 0)
    position = np.array([10, 20, 30]) + height * normal
    item = of(
        PlanePositionSequence=Sequence([of(ImagePositionPatient=[f"{v:.8g}" for v in position])]),
        SegmentIdentificationSequence=Sequence([of(ReferencedSegmentNumber=9 if case == "unlisted" and n == 3 else number)]),
    )
    if case == "turned" and n == 2:
        item.PlaneOrientationSequence = Sequence([of(ImageOrientationPatient=[1, 0, 0, 0, 1, 0])])
    items.append(item)
    pixels.append(masks[number][k])
d.PerFrameFunctionalGroupsSequence, d.NumberOfFrames = Sequence(items), len(items)
pixels = np.array(pixels)
if fractional:
    inside = rng.integers(100, 201, pixels.shape)
    content = np.where(pixels, inside, rng.integers(0, 100, pixels.shape)).astype("u1").tobytes()
else:
    content = np.packbits(pixels.ravel(), bitorder="little").tobytes()
if case == "short":
    content = content[:-8]
d.PixelData = content + b"\0" * (len(content) % 2)
d["PixelData"].VR = "OB"
d.save_as(path, write_like_original=False)
first = min(k for _, k in frames)
labels = np.where(masks[1], 1, np.where(masks[4], 4, 0)).astype("u1")[first:]
overlapped = masks[4][first:].astype("u1") if case == "overlapping" else b""
open(truth_path, "wb").write(labels.tobytes() + bytes(overlapped))
