# SPDX-License-Identifier: Apache-2.0
"""What packaging/try_wheel runs in a system without kontur's dependencies, of which the folder of this file has the input.
With --compiler-alone for a wheel that was built without libraries, and refuses what needs them."""
import pathlib
import sys
import tempfile

import numpy as np

import kontur

HERE = pathlib.Path(__file__).parent
HAS_LIBRARIES = "--compiler-alone" not in sys.argv


def refuse(what, task):
    try:
        task()
    except kontur.UnsupportedError as error:
        print(f"refused: {error}")
    else:
        raise AssertionError(f"there is {what}")


case = kontur.phantom_case("kidney_radial6")
made = kontur.segment(case.contours, case.grid, mesh=True)
dice = kontur.compare(made.mask, kontur.make_truth_mask(case.body, case.grid)).dice
print(f"kontur {kontur.__version__}: {made.report.mask_volume_ml:.3f} ml, Dice {dice:.4f}")
assert dice > 0.95

outer = kontur.derive("PTV = Kidney + 5 mm", {"Kidney": made})["PTV"].mask
assert outer.volume_ml > 1.3 * made.mask.volume_ml
print(f"derived: {outer.volume_ml:.3f} ml")

ball = np.sum((np.mgrid[:41, :40, :40] - 20) ** 2, axis=0) < 15**2
bitten = ball & ~((np.arange(40) > 27) & (abs(np.arange(41) - 20) < 6)[:, None, None])
grid = kontur.Grid((40, 40, 41), np.eye(4), frame="LPS")
outline = kontur.trace(kontur.Mask(ball, grid), [kontur.Plane([0, 0, 20], [0, 0, 1])])
corrected = kontur.correct(kontur.Mask(bitten, grid), outline).mask
assert corrected.volume_ml > kontur.Mask(bitten, grid).volume_ml
print(f"corrected: {corrected.volume_ml:.3f} ml")

slices = np.where(np.arange(41)[:, None, None] % 4 == 2, ball, 0).astype(np.uint8)
filled = kontur.fill_labels(slices, (1, 1, 1))
assert np.count_nonzero(filled) > 3 * np.count_nonzero(slices)
print(f"filled: {np.count_nonzero(filled)} voxels")

beats = [kontur.Contour(contour.points, frame=frame) for frame in (1, 3) for contour in case.contours]
moving = kontur.segment_moving(kontur.ContourSet(beats), case.grid, [1, 2, 3])
assert len(moving.masks) == 3 and all(mask.volume_ml > 1 for mask in moving.masks)
print(f"moving: {moving.masks[1].volume_ml:.3f} ml between two frames")

with tempfile.TemporaryDirectory() as folder:
    for name in ("mask.nii", "mask.nii.gz", "mask.nrrd", "mask.mha")[: None if HAS_LIBRARIES else 1]:
        path = pathlib.Path(folder, name)
        kontur.write_mask(path, made.mask)
        assert np.array_equal(kontur.read_mask(path).values, made.mask.values), name
        print(f"{name}: {path.stat().st_size} bytes written and read")
    if not HAS_LIBRARIES:
        refuse("compression", lambda: kontur.write_mask(pathlib.Path(folder, "mask.nii.gz"), made.mask))
        preamble = pathlib.Path(folder, "slice.dcm")
        preamble.write_bytes(bytes(128) + b"DICM")
        refuse("DICOM", lambda: kontur.read_image(preamble))
        refuse("DICOM", lambda: kontur.read_rtstruct(preamble))

for series in sorted(path for path in HERE.iterdir() if (path / "truth.raw").exists()):
    truth = np.fromfile(series / "truth.raw")
    samples = kontur.read_image(series / "dicom").samples
    assert np.array_equal(samples.ravel(), truth), series.name
    print(f"DICOM {series.name}: {samples.shape} read")

if (HERE / "cyrillic").exists():
    [series] = kontur.list_dicom_series(HERE / "cyrillic")
    assert series.description == "Печень", series.description
    print(f"DICOM in Cyrillic: {series.description}")

refuse("a dense solver", lambda: kontur.segment(case.contours, case.grid, solver="dense"))
refuse("a picture", lambda: kontur.make_picture(made.mesh, case.contours))
try:  # libcurl is the system's, where it has one
    kontur.archive.find("http://127.0.0.1:9/dicom-web")
except (kontur.UnsupportedError, kontur.FileError) as error:
    print(f"refused: {error}")
else:
    raise AssertionError("nobody is there")
