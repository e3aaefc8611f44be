# SPDX-License-Identifier: Apache-2.0
"""Smooth 3D organs from a few hand-drawn contours.

Coordinates are millimetres in DICOM's patient frame LPS; arrays over a grid have the shape (z, y, x); lengths carry their unit in
the name. The stages of `segment` are functions too, in `kontur.stages`. `kontur.archive` speaks with a PACS.

Research software, not a medical device.

Examples
--------
>>> import kontur
>>> case = kontur.phantom_case("kidney_radial6")
>>> kidney = kontur.segment(case.contours, case.grid)
>>> truth = kontur.make_truth_mask(case.body, case.grid)
>>> kontur.compare(kidney.mask, truth).dice > 0.97
True
"""
from ._core import *
from ._core import __version__
from . import archive, notebook, stages
from .converters import from_nibabel, from_sitk, to_nibabel, to_sitk
from .errors import (
    CancelledError,
    CorruptFileError,
    Error,
    FileError,
    InvalidInputError,
    MissingFileError,
    SingularSystemError,
    TooLargeError,
    UnsupportedError,
)

__all__ = sorted(name for name in globals() if not name.startswith("_") and name not in ("archive", "converters", "errors", "notebook", "stages"))

# Where users find them, in messages and in pickles.
for _name in __all__:
    globals()[_name].__module__ = "kontur"
del _name
