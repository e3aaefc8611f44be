// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// Where the implicit function is prescribed, and its value there. Values are in mm, so that |f| near the surface is about
/// the distance to it; with an offset of 1 mm they are the paper's 0 and -1.
struct ConstraintSet {
    std::vector<Vec3> centers;
    std::vector<double> values;
    std::vector<double> trust;     ///< > 0, the smoothing of a constraint is divided by it; empty: all 1
    std::vector<double> noise_mm;  ///< >= 0, standard deviations of the values, beside smoothing; empty: all 0
    std::vector<double> extents;   ///< in (0, 1]: a constraint is smoothed as one of a drawing so much smaller; empty: all 1

    std::size_t size() const { return centers.size(); }
};

}  // namespace kontur
