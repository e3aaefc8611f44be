// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace kontur {

/// A threshold that nothing flips at: 0 up to `from`, 1 from `to` on, a straight line between.
struct Rise {
    double from, to;

    double at(double x) const { return std::clamp((x - from) / (to - from), 0.0, 1.0); }
};

/// A mean in its standard errors. Of one that has none, infinitely many, or 0.
inline double in_errors(double mean, double standard_error) {
    if (standard_error > 0) return mean / standard_error;
    return mean == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), mean);
}

}  // namespace kontur
