// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kontur/shape/contour.h"

namespace kontur {

/// One contour on its way to the fit.
struct PreparedLine {
    std::int32_t number = 0;  ///< of the drawn contour, which a copy shares
    Contour reduced;          ///< as it was drawn, with fewer points where that is asked for
    Contour fitted;           ///< all of these, and more where they are far apart
    /// > 0: who draws in steps no longer than this has drawn what is there; such an edge is not looked at for being narrow.
    double long_mm = 0;
    double shortest_mm = 0;  ///< > 0: no piece of an edge that is subdivided becomes shorter
};

}  // namespace kontur
