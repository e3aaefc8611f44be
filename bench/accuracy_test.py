# SPDX-License-Identifier: Apache-2.0
"""kontur_accuracy --tilts on a ball, whose surface's direction is known."""
import json
import os
import subprocess

import nibabel
import numpy as np
import pytest

RADIUS, SIZE, MIDDLE = 14.0, 48, 23.5
LPS = np.diag([-1.0, -1.0, 1.0, 1.0])


def circles(heights):
    """Axial sections of the ball, mm."""
    turns = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    planes = []
    for height in heights:
        origin = [MIDDLE, MIDDLE, MIDDLE + height]
        ring = np.array(origin) + np.sqrt(RADIUS**2 - height**2) * np.column_stack([np.cos(turns), np.sin(turns), 0 * turns])
        planes.append({"origin": origin, "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0],
                       "contours": [{"points": ring.tolist()}]})
    return {"frame": "LPS mm", "planes": planes}


@pytest.fixture(scope="module")
def row(tmp_path_factory):
    folder = tmp_path_factory.mktemp("drawings")
    body = folder / "ball"
    body.mkdir()
    truth = ((np.indices((SIZE, SIZE, SIZE)) - MIDDLE) ** 2).sum(axis=0) < RADIUS**2
    nibabel.save(nibabel.Nifti1Image(truth.astype(np.uint8), LPS), body / "truth.nii.gz")
    (body / "slices.json").write_text(json.dumps(circles([-10, 0, 10])))
    done = subprocess.run([os.environ["KONTUR_ACCURACY"], "--without-paper", "--without-phantom", "--tilts", folder], check=True,
                          capture_output=True, text=True)
    [only] = json.loads(done.stdout)
    assert (only["object"], only["drawing"]) == ("ball", "slices")
    return only


def test_normals_of_a_mask_are_those_of_the_body(row):
    assert row["normals"]["of_truth_degrees"] < 1.5  # blurred more or less, a ball's normals are its radii
    assert row["normals"]["in_plane_degrees"] < 1.5  # circles tell them
    assert row["true_tilts_normals"]["degrees"] < 2.5


def test_true_tilts_make_normals_better_where_slices_do_not_show_them(row):
    assert row["true_tilts_normals"]["degrees"] < row["normals"]["degrees"]
    assert row["true_tilts"]["dice"] > row["kontur"]["dice"]
