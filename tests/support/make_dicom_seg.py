# SPDX-License-Identifier: Apache-2.0
"""make_dicom_seg.py CASE FILE TRUTH: writes a DICOM segmentation of two segments on 6 slices of 7 x 5 pixels.

CASE: "shuffled" (frames in no order, those without voxels left out), "overlapping", "fractional" ("fractional_0",
"fractional_1000": with that MaximumFractionalValue), "halved" (half of the true spacing is declared, "hair": 1/100 mm, with
frames 0.3 mm off), "labelmap" (one frame for a slice; "labelmap_16": the
second segment has the number 300, "labelmap_padded": 9 is the background, "labelmap_unpadded", "labelmap_palette"), what any but the
binary ones may end with: "_rle", "_deflated", "_frames" (each deflated by itself, the binary "shuffled_frames", too), or what is
wrong: "labelmap_unlisted", "irregular", "turned", "unlisted", "short", "kind". TRUTH gets the label map that it shows (uint8, i fastest); of
overlapping ones, segment 1 is in front, and the mask of segment 4 follows.
"""

import random
import sys
import zlib

import numpy as np
from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.encaps import encapsulate
from pydicom.sequence import Sequence
from pydicom.uid import ExplicitVRLittleEndian, RLELossless, generate_uid

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
fractional, label_map = case.startswith("fractional"), case.startswith("labelmap")
d.SegmentationType = "FRACTIONAL" if fractional else "LABELMAP" if label_map or case == "kind" else "BINARY"
d.BitsAllocated = d.BitsStored = 16 if case == "labelmap_16" else 8 if fractional or label_map else 1
if label_map:
    d.SOPClassUID = meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.66.7"
    second = 300 if case == "labelmap_16" else 4
    padding = 9 if case == "labelmap_padded" else 0
    if case != "labelmap_unpadded":
        d.PixelPaddingValue = padding
if case == "labelmap_palette":
    d.PhotometricInterpretation = "PALETTE COLOR"
    for colour in ("Red", "Green", "Blue"):
        setattr(d, f"{colour}PaletteColorLookupTableDescriptor", [256, 0, 8])
        setattr(d, f"{colour}PaletteColorLookupTableData", bytes(range(256)))
d.HighBit = d.BitsStored - 1
if fractional:
    d.MaximumFractionalValue = int(case[11:]) if case[11:].isdigit() else 200
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
if label_map:
    frames = [(0, k) for k in range(NZ) if masks[1][k].any() or masks[4][k].any()]
    masks[0] = np.select([masks[1], masks[4]], [1, second], padding)
    d.SegmentSequence[1].SegmentNumber = second
    if case == "labelmap_padded":  # as some programs do
        d.SegmentSequence.append(of(SegmentNumber=9, SegmentLabel="Background", SegmentAlgorithmType="MANUAL"))
random.Random(3).shuffle(frames)
items, pixels = [], []
for n, (number, k) in enumerate(frames):
    height = 2 * k + (0.3 if case in ("irregular", "hair") and n == 0 else 2e19 if case == "far" and n == 0 else 0)
    position = np.array([10, 20, 30]) + height * normal
    item = of(
        PlanePositionSequence=Sequence([of(ImagePositionPatient=[f"{v:.8g}" for v in position])]),
        SegmentIdentificationSequence=Sequence([of(ReferencedSegmentNumber=9 if case == "unlisted" and n == 3 else number)]),
    )
    if label_map:
        del item.SegmentIdentificationSequence
    if case == "turned" and n == 2:
        item.PlaneOrientationSequence = Sequence([of(ImageOrientationPatient=[1, 0, 0, 0, 1, 0])])
    items.append(item)
    pixels.append(masks[number][k])
d.PerFrameFunctionalGroupsSequence, d.NumberOfFrames = Sequence(items), len(items)
pixels = np.array(pixels)
if case == "labelmap_unlisted":
    pixels[2, 1, 1] = 7
if label_map:
    content = pixels.astype("<u2" if case == "labelmap_16" else "u1").tobytes()
elif fractional:
    inside = rng.integers(100, 201, pixels.shape)
    content = np.where(pixels, inside, rng.integers(0, 100, pixels.shape)).astype("u1").tobytes()
else:
    content = np.packbits(pixels.ravel(), bitorder="little").tobytes()
if case == "short":
    content = content[:-8]
d.PixelData = content + b"\0" * (len(content) % 2)
d["PixelData"].VR = "OW" if case == "labelmap_16" else "OB"
deflated_frames = case.endswith("_frames")
if case.endswith("_rle"):
    d.compress(RLELossless)
if case.endswith("_deflated"):
    meta.TransferSyntaxUID = "1.2.840.10008.1.2.1.99"
if deflated_frames:  # pydicom 2 does not know them: written as run-length coded, then renamed
    each = [np.packbits(p.ravel(), bitorder="little") if d.BitsAllocated == 1 else p.astype("u1") for p in pixels]
    if fractional:
        each = np.frombuffer(content, "u1").reshape(pixels.shape)
    codes = []
    for frame in each:
        deflate = zlib.compressobj(9, zlib.DEFLATED, -15)
        codes.append(deflate.compress(frame.tobytes()) + deflate.flush())
    meta.TransferSyntaxUID = "1.2.840.10008.1.2.4.80"  # as long as the right one, with a character of padding
    d.PixelData = encapsulate(codes)
    d["PixelData"].is_undefined_length = True
d.save_as(path, write_like_original=False)
if deflated_frames:
    written = open(path, "rb").read().replace(b"1.2.840.10008.1.2.4.80", b"1.2.840.10008.1.2.8.1\0")
    open(path, "wb").write(written)
first = min(k for _, k in frames)
labels = np.where(masks[1], 1, np.where(masks[4], 4, 0)).astype("u1")[first:]  # 4 stands for 300, too
overlapped = masks[4][first:].astype("u1") if case == "overlapping" else b""
open(truth_path, "wb").write(labels.tobytes() + bytes(overlapped))
