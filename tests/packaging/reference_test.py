# SPDX-License-Identifier: Apache-2.0
"""The C++ reference is written from the public headers without a warning."""
import os
import pathlib
import re
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).parents[2]
DOXYFILE = pathlib.Path(os.environ["KONTUR_BUILD"]) / "packaging" / "Doxyfile"

pytestmark = pytest.mark.skipif(not shutil.which("doxygen"), reason="doxygen is not installed")


def doxygen(folder, more=""):
    """Doxygen with the project's settings, writing into the folder."""
    settings = DOXYFILE.read_text() + f"\nOUTPUT_DIRECTORY = {folder}\n{more}"
    return subprocess.run(["doxygen", "-"], input=settings, capture_output=True, text=True, timeout=120)


def test_there_is_no_warning(tmp_path):
    result = doxygen(tmp_path)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    pages = {page.name for page in (tmp_path / "html").iterdir()}
    assert {"index.html", "structkontur_1_1SegmentOptions.html", "classkontur_1_1ImplicitFunction.html"} <= pages


def test_every_name_of_the_first_page_leads_to_its_description(tmp_path):
    doxygen(tmp_path)
    page = (tmp_path / "html" / "index.html").read_text()
    names = re.findall(r"kontur::(\w+)", (ROOT / "docs/reference/main.md").read_text())
    assert len(names) > 30
    for name in names:
        assert re.search(rf'<a class="el" href="[^"]+"[^>]*>kontur::{name}(\(\))?</a>', page), name


def test_a_comment_that_documents_what_is_not_there_is_an_error(tmp_path):
    header = tmp_path / "wrong.h"
    header.write_text("/// Doubles.\n/// @param y what is no parameter\nint twice(int x);\n")
    result = doxygen(tmp_path, f"INPUT += {header}\n")
    assert result.returncode != 0 and "wrong.h" in result.stderr
