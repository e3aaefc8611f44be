# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys

import kontur
import numpy
import pytest

sys.path.append(str(pathlib.Path(__file__).parents[2] / "tests/support"))
from skips import pytest_sessionfinish  # noqa: E402, F401


@pytest.fixture(scope="session")
def case():
    """The phantom's kidney from six contours: half a second to segment."""
    return kontur.phantom_case("kidney_radial6")


@pytest.fixture(scope="session")
def kidney(case):
    return kontur.segment(case.contours, case.grid, mesh=True)


@pytest.fixture
def oblique():
    """A sheared, left-handed grid without any two equal numbers."""
    affine = numpy.array([[0.8, 0.1, -0.3, 10], [-0.2, 0.9, 0.25, -20], [0.05, 0.15, -2.5, 30], [0, 0, 0, 1]])
    return kontur.Grid((5, 4, 3), affine, frame="LPS")
