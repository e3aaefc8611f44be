# SPDX-License-Identifier: Apache-2.0
"""What packaging/try_wheel runs in a system without kontur's dependencies, of which the folder of this file has the input."""
import pathlib
import tempfile

import numpy as np

import kontur

HERE = pathlib.Path(__file__).parent

case = kontur.phantom_case("kidney_radial6")
made = kontur.segment(case.contours, case.grid, mesh=True)
dice = kontur.compare(made.mask, kontur.make_truth_mask(case.body, case.grid)).dice
print(f"kontur {kontur.__version__}: {made.report.mask_volume_ml:.3f} ml, Dice {dice:.4f}")
assert dice > 0.95

with tempfile.TemporaryDirectory() as folder:
    for name in ("mask.nii.gz", "mask.nrrd", "mask.mha"):
        path = pathlib.Path(folder, name)
        kontur.write_mask(path, made.mask)
        assert np.array_equal(kontur.read_mask(path).values, made.mask.values), name
        print(f"{name}: {path.stat().st_size} bytes written and read")

for series in sorted(path for path in HERE.iterdir() if (path / "truth.raw").exists()):
    truth = np.fromfile(series / "truth.raw")
    samples = kontur.read_image(series / "dicom").samples
    assert np.array_equal(samples.ravel(), truth), series.name
    print(f"DICOM {series.name}: {samples.shape} read")

try:
    kontur.segment(case.contours, case.grid, solver="dense")
except kontur.UnsupportedError as error:
    print(f"refused: {error}")
else:
    raise AssertionError("there is no dense solver")
try:
    kontur.make_picture(made.mesh, case.contours)
except kontur.UnsupportedError as error:
    print(f"refused: {error}")
else:
    raise AssertionError("there are no pictures")
