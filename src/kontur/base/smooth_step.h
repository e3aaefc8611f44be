// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace kontur {

/// 0 up to `from`, 1 from `to` on, smooth between them; from < to.
inline double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace kontur
