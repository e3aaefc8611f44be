# SPDX-License-Identifier: Apache-2.0
"""check_rtstruct.py FILE IMAGES: what pydicom and dciodvfy say about a structure set made on the images in a folder.

Fails when a reference leads nowhere, a contour does not lie on the slice that it names, a count is wrong, or dciodvfy finds
an error. Prints "APPROVED by NAME on DATE at TIME" if it is, a line "NUMBER NAME TYPE ALGORITHM R,G,B" for each ROI, lines for its
description, code, comment and physical properties where it has them, and one "GEOMETRY POINTS ENCLOSED_MM2 SLICE_OR_-" for
each of its contours.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pydicom

path, folder = sys.argv[1:]
structures = pydicom.dcmread(path)
images = {image.SOPInstanceUID: image for image in (pydicom.dcmread(p) for p in Path(folder).glob("*.dcm"))}
any_image = next(iter(images.values()))

assert structures.file_meta.TransferSyntaxUID == "1.2.840.10008.1.2", "implicit VR, little endian"
assert structures.SpecificCharacterSet == "ISO_IR 192"
for word in ("PatientName", "PatientID", "StudyInstanceUID", "FrameOfReferenceUID"):
    assert structures[word].value == any_image[word].value, word
assert structures.SeriesInstanceUID != any_image.SeriesInstanceUID
assert structures.SOPInstanceUID == structures.file_meta.MediaStorageSOPInstanceUID not in images

[frame] = structures.ReferencedFrameOfReferenceSequence
[study] = frame.RTReferencedStudySequence
[series] = study.RTReferencedSeriesSequence
assert frame.FrameOfReferenceUID == any_image.FrameOfReferenceUID
assert study.ReferencedSOPInstanceUID == any_image.StudyInstanceUID
assert series.SeriesInstanceUID == any_image.SeriesInstanceUID
assert {i.ReferencedSOPInstanceUID for i in series.ContourImageSequence} == set(images)


def enclosed_mm2(points):
    return np.linalg.norm(np.cross(points - points[0], np.roll(points, -1, axis=0) - points[0]).sum(axis=0)) / 2


if structures.ApprovalStatus == "APPROVED":
    print(f"APPROVED by {structures.ReviewerName} on {structures.ReviewDate} at {structures.ReviewTime}")
else:
    assert structures.ApprovalStatus == "UNAPPROVED"
    assert not {"ReviewerName", "ReviewDate", "ReviewTime"} & set(structures.dir("Review")), "nobody reviewed it"

contours_of = {r.ReferencedROINumber: r for r in structures.ROIContourSequence}
observation_of = {o.ReferencedROINumber: o for o in structures.RTROIObservationsSequence}
type_of = {number: o.RTROIInterpretedType for number, o in observation_of.items()}
for roi in structures.StructureSetROISequence:
    assert roi.ReferencedFrameOfReferenceUID == any_image.FrameOfReferenceUID
    stored = contours_of[roi.ROINumber]
    color = ",".join(map(str, stored.get("ROIDisplayColor", [])))
    print(roi.ROINumber, roi.ROIName, type_of[roi.ROINumber] or "-", roi.ROIGenerationAlgorithm or "-", color)
    if "ROIDescription" in roi:
        print("DESCRIPTION", roi.ROIDescription)
    for code in observation_of[roi.ROINumber].get("RTROIIdentificationCodeSequence", []):
        print("CODE", code.CodeValue, code.CodingSchemeDesignator, code.CodeMeaning)
    if "ROIObservationDescription" in observation_of[roi.ROINumber]:
        print("COMMENT", observation_of[roi.ROINumber].ROIObservationDescription)
    for one in observation_of[roi.ROINumber].get("ROIPhysicalPropertiesSequence", []):
        print("PROPERTY", one.ROIPhysicalProperty, one.ROIPhysicalPropertyValue)
    for contour in stored.get("ContourSequence", []):
        points = np.array(contour.ContourData, float).reshape(-1, 3)
        assert len(points) == contour.NumberOfContourPoints
        assert all(len(value.original_string) <= 16 for value in contour.ContourData)
        slice_name = "-"
        if "ContourImageSequence" in contour:
            [reference] = contour.ContourImageSequence
            image = images[reference.ReferencedSOPInstanceUID]
            assert reference.ReferencedSOPClassUID == image.SOPClassUID
            normal = np.cross(image.ImageOrientationPatient[:3], image.ImageOrientationPatient[3:])
            off = np.abs((points - np.array(image.ImagePositionPatient, float)) @ normal).max()
            assert off < 1e-4, f"{off} mm off its slice"
            slice_name = f"{normal @ np.array(image.ImagePositionPatient, float):.3f}"
        print(contour.ContourGeometricType, len(points), f"{enclosed_mm2(points):.4f}", slice_name)

verdict = subprocess.run(["dciodvfy", path], capture_output=True, text=True).stderr
assert "Error" not in verdict, verdict
