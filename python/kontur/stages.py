# SPDX-License-Identifier: Apache-2.0
"""The stages of `segment`, each to be called by itself, and the tools beside them.

Unstable: names, options and results follow the method and change with it in any version; those of `kontur` do not.

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> fitted = kontur.stages.fit(kontur.stages.prepare(case.contours))
>>> kontur.stages.residual(fitted.function, case.contours).max_mm < 0.5
True
"""
from ._core import _stages
from ._core._stages import *

__all__ = sorted(name for name in vars(_stages) if not name.startswith("_"))

# Where users find them, in messages and in pickles.
for _name in __all__:
    globals()[_name].__module__ = "kontur.stages"
del _name, _stages
