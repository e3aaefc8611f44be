# SPDX-License-Identifier: Apache-2.0
"""check_dicom_seg.py FILE IMAGES TRUTH: what pydicom and dciodvfy say about a segmentation made on the images in a folder.

TRUTH holds the label map (uint8, i fastest) on the images' grid. Fails when a voxel is wrong, a frame does not lie on the
slice that it names, or dciodvfy finds an error. Prints a line for each segment.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pydicom

path, folder, truth_path = sys.argv[1:]
seg = pydicom.dcmread(path)
images = {image.SOPInstanceUID: image for image in (pydicom.dcmread(p) for p in Path(folder).glob("*.dcm"))}
first = next(iter(images.values()))
normal = np.cross(first.ImageOrientationPatient[:3], first.ImageOrientationPatient[3:])
order = sorted(images, key=lambda uid: normal @ np.array(images[uid].ImagePositionPatient, float))
truth = np.fromfile(truth_path, "u1").reshape(len(order), first.Rows, first.Columns)

for word in ("PatientName", "PatientID", "StudyInstanceUID", "FrameOfReferenceUID", "Rows", "Columns"):
    assert seg[word].value == first[word].value, word
[series] = seg.ReferencedSeriesSequence
assert series.SeriesInstanceUID == first.SeriesInstanceUID
assert {i.ReferencedSOPInstanceUID for i in series.ReferencedInstanceSequence} == set(images)
[shared] = seg.SharedFunctionalGroupsSequence
assert np.allclose(shared.PlaneOrientationSequence[0].ImageOrientationPatient, first.ImageOrientationPatient, atol=1e-6)
assert np.allclose(shared.PixelMeasuresSequence[0].PixelSpacing, first.PixelSpacing)

seen = np.zeros_like(truth)
pixels = seg.pixel_array
for frame, inside in zip(seg.PerFrameFunctionalGroupsSequence, pixels):
    [source] = frame.DerivationImageSequence[0].SourceImageSequence
    image = images[source.ReferencedSOPInstanceUID]
    assert np.allclose(frame.PlanePositionSequence[0].ImagePositionPatient, image.ImagePositionPatient, atol=1e-4)
    number = frame.SegmentIdentificationSequence[0].ReferencedSegmentNumber
    k = order.index(image.SOPInstanceUID)
    assert list(frame.FrameContentSequence[0].DimensionIndexValues) == [number, k + 1]
    seen[k][inside != 0] = number
assert np.array_equal(seen, truth), f"{(seen != truth).sum()} voxels differ"

for n, s in enumerate(seg.SegmentSequence, start=1):
    assert s.SegmentNumber == n
    print(n, s.SegmentLabel, s.SegmentAlgorithmType, s.SegmentAlgorithmName, list(s.get("RecommendedDisplayCIELabValue", [])))
    for a in s.get("SegmentationAlgorithmIdentificationSequence", []):
        print("algorithm:", a.AlgorithmName, a.AlgorithmVersion, a.AlgorithmParameters)
verdict = subprocess.run(["dciodvfy", path], capture_output=True, text=True).stderr
assert "Error" not in verdict, verdict
