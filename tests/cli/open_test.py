# SPDX-License-Identifier: Apache-2.0
"""kontur open before it serves: where the project is kept, and what it is not asked to open. What it serves: tests/viewer."""
import os

import pytest
from support import ball_array, kontur, names, write_nifti


@pytest.mark.parametrize("home", [None, "", "relative"])
@pytest.mark.parametrize("data", [None, "", "relative"])
def test_without_a_home_folder_the_project_needs_a_place(tmp_path, home, data):
    image = write_nifti(tmp_path / "image.nii.gz", ball_array())
    environment = {name: value for name, value in os.environ.items() if name not in ("HOME", "XDG_DATA_HOME")}
    environment |= {name: value for name, value in (("HOME", home), ("XDG_DATA_HOME", data)) if value is not None}
    result = kontur("open", image, "--no-browser", cwd=tmp_path, env=environment)
    assert result.returncode == 65
    assert result.stderr == "kontur: error: there is no home folder to keep the project in; give --project\n"
    assert names(tmp_path) == ["image.nii.gz"]


def test_two_projects_are_refused(tmp_path):
    (tmp_path / "a.kontur").touch()
    result = kontur("open", "a.kontur", "--project", "b.kontur", "--no-browser", cwd=tmp_path)
    assert result.returncode == 65
    assert "a.kontur and --project b.kontur are two projects" in result.stderr
    assert names(tmp_path) == ["a.kontur"]
