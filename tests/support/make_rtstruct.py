# SPDX-License-Identifier: Apache-2.0
"""make_rtstruct.py CASE FILE: writes an RT structure set.

CASE is "good", with one ROI for each way to store contours, "long" (with very long ones besides), "explicit" (the same in
explicit VR, where long contour data become VR UN), or what is wrong: "number", "triples", "count", "unlisted", "empty",
"twice" (a second item with contours of the first ROI), "erased" (the same without contours), "orphan" (an observation of a
ROI that is not listed), "offset" (contours shifted by a vector).
"""

import math
import sys

from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
from pydicom.sequence import Sequence
from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian, generate_uid

STORAGE = "1.2.840.10008.5.1.4.1.1.481.3"


def square(low, high, z=0.0):
    return [(low, low, z), (high, low, z), (high, high, z), (low, high, z)]


def ring(points, shift, z):
    return [
        (shift + 10 * math.cos(2 * math.pi * k / points), 10 * math.sin(2 * math.pi * k / points), z)
        for k in range(points)
    ]


def oblique(radius, height):
    """A circle in the plane through (0, 0, height) with the normal (0.6, 0, 0.8)."""
    angles = [2 * math.pi * k / 40 for k in range(40)]
    return [
        (0.6 * height + 0.8 * radius * math.cos(a), radius * math.sin(a), 0.8 * height - 0.6 * radius * math.cos(a))
        for a in angles
    ]


def keyhole(width):
    """A square with a square hole; the channel between (0, 0) and (2, 2) is `width` mm wide."""
    inner = [(2, 2, 0), (2, 6, 0), (6, 6, 0), (6, 2, 0), (2 + width, 2, 0)]
    return [(0, 0, 0)] + inner + [(width, 0, 0), (8, 0, 0), (8, 8, 0), (0, 8, 0)]


PLANAR, XOR = "CLOSED_PLANAR", "CLOSEDPLANAR_XOR"
ROIS = {
    "plain": [(PLANAR, square(0, 10)), (PLANAR, square(0, 10, 3.0))],
    "keyhole": [(PLANAR, keyhole(0)), (PLANAR, [(x, y, 5.0) for x, y, z in keyhole(0.0005)])],
    "wide channel": [(PLANAR, keyhole(0.1))],
    "exclusive": [(XOR, square(0, 9)), (XOR, square(3, 6))],
    "nested": [(PLANAR, square(3, 6)), (PLANAR, square(0, 9)), (PLANAR, square(4, 5)), (PLANAR, square(3, 6, 3.0))],
    "overlapping": [(PLANAR, square(0, 6)), (PLANAR, square(3, 9))],
    "other types": [
        ("POINT", [(1, 2, 3)]),
        ("OPEN_PLANAR", square(0, 4)),
        (PLANAR, square(0, 4)),
        ("OPEN_NONPLANAR", square(0, 4)),
        ("OPEN_PLANAR", [(0, 0, 5), (3, 0, 5)]),
        ("OPEN_PLANAR", [(0, 0, 5), (0, 0, 5)]),
    ],
    "without area": [
        (PLANAR, [(0, 0, 0), (1, 0, 0)]),
        (PLANAR, [(0, 0, 0), (1, 0, 0), (2, 0, 0)]),
        (PLANAR, square(0, 4)),
    ],
    "repeated": [
        (PLANAR, square(0, 4)),
        (PLANAR, square(0, 4)),
        (PLANAR, square(0, 4) + [(0, 0, 0)]),
        (PLANAR, square(0, 4)[2:] + square(0, 4)[:2]),
        (PLANAR, square(0, 4)[::-1]),
        (PLANAR, [(x + 0.0002, y, z) for x, y, z in square(0, 4)]),
        (PLANAR, square(1, 2)),
    ],
    "closing point": [(PLANAR, square(0, 4) + [(0, 0, 0)])],
    "empty": [],
    "oblique": [(PLANAR, oblique(10, 0)), (PLANAR, oblique(10, 5)), (PLANAR, oblique(0.02, 5))],
    "L\u00e4sion": [(PLANAR, square(0, 4))],
    "long": [(PLANAR, ring(30000, 0, 1.25)), (PLANAR, ring(1000, 30, 1.25))],
}


def decimal(value):
    return f"{value:.10g}"


def contour_item(kind, points, number):
    item = Dataset()
    item.ContourGeometricType, item.NumberOfContourPoints, item.ContourNumber = kind, len(points), number
    item.ContourData = [decimal(v) for point in points for v in point]
    return item


def main(case, path):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = STORAGE, generate_uid()
    explicit = case == "explicit"
    meta.TransferSyntaxUID = ExplicitVRLittleEndian if explicit else ImplicitVRLittleEndian
    d = FileDataset("", {}, file_meta=meta, preamble=b"\0" * 128)
    d.is_little_endian, d.is_implicit_VR = True, not explicit
    d.SOPClassUID, d.SOPInstanceUID = STORAGE, meta.MediaStorageSOPInstanceUID
    d.SpecificCharacterSet = "ISO_IR 100"
    d.Modality, d.PatientID, d.StructureSetLabel = "RTSTRUCT", "P1", "TEST"
    frame = generate_uid(entropy_srcs=["frame"])
    listed, contours, observations = [], [], []
    if case not in ("long", "explicit"):
        del ROIS["long"]
    for number, (name, stored) in enumerate(ROIS.items(), start=1):
        roi = Dataset()
        roi.ROINumber, roi.ROIName, roi.ReferencedFrameOfReferenceUID = number, name, frame
        listed.append(roi)
        contour = Dataset()
        contour.ReferencedROINumber, contour.ROIDisplayColor = number, [number, 2, 255]
        if stored:
            items = [contour_item(kind, points, n) for n, (kind, points) in enumerate(stored, start=1)]
            contour.ContourSequence = Sequence(items)
        contours.append(contour)
        observation = Dataset()
        observation.ObservationNumber = observation.ReferencedROINumber = number
        observation.RTROIInterpretedType = "ORGAN"
        observations.append(observation)
    second = contours[0].ContourSequence[1]
    if case == "number":  # pydicom refuses to write it, so it is put in afterwards
        second.ContourData = ["123454321"] + list(second.ContourData)[1:]
    if case == "triples":
        second.ContourData = list(second.ContourData)[:-1]
    if case == "count":
        second.NumberOfContourPoints = 5
    if case == "unlisted":
        contours[0].ReferencedROINumber = 99
    if case in ("twice", "erased"):
        again = Dataset()
        again.ReferencedROINumber = 1
        if case == "twice":
            again.ContourSequence = Sequence([contour_item(PLANAR, square(0, 10, 6.0), 1)])
        contours.append(again)
    if case == "offset":
        second.add_new(0x30060045, "DS", ["0", "0", "2.5"])
    if case == "orphan":
        observations[0].ReferencedROINumber = 99
    d.StructureSetROISequence, d.ROIContourSequence = Sequence(listed), Sequence(contours)
    d.RTROIObservationsSequence = Sequence(observations)
    if case == "empty":
        del d.ROIContourSequence
    d.save_as(path, write_like_original=False)
    if case == "number":
        with open(path, "rb") as file:
            content = file.read()
        with open(path, "wb") as file:
            file.write(content.replace(b"123454321", b"12345,321"))


main(sys.argv[1], sys.argv[2])
