// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/section_probes.h"

#include <algorithm>
#include <cmath>

namespace kontur {

std::vector<Probe> probes(const Section& section) {
    Point2 low{1e300, 1e300}, high{-1e300, -1e300};
    for (const Polygon2& outline : section.outlines)
        for (const Point2& p : outline)
            for (std::size_t axis = 0; axis < 2; ++axis) {
                low[axis] = std::min(low[axis], p[axis]);
                high[axis] = std::max(high[axis], p[axis]);
            }
    const double width = high[0] - low[0], height = high[1] - low[1];
    const double step = std::max(std::sqrt(width * height / 150), std::max(width, height) / 100);
    std::vector<Probe> result;
    for (double v = low[1] + step / 2; v < high[1]; v += step)
        for (double u = low[0] + step / 2; u < high[0]; u += step)
            if (const Point2 at{u, v}; section.contains(at))
                if (const double depth = section.clearance(at); depth > step / 2) result.push_back({at, depth});
    return result;
}

}  // namespace kontur
