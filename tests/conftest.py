# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).parent / "support"))
from skips import pytest_sessionfinish  # noqa: E402, F401
