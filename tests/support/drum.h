// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "support/lobed_body.h"

namespace kontur::test {

/// Positive inside a drum around the z axis, its edges rounded a little. Contours alone make domes of its ends; an image
/// shows that they are flat.
inline double drum_depth(const Vec3& p) {
    const double side = 22 - std::hypot(p.x, p.y), end = 22.5 - std::abs(p.z);
    return -2 * std::log(std::exp(-side / 2) + std::exp(-end / 2));
}

inline double drum_look(const Vec3& p) { return two_tissues(drum_depth(p)); }

inline std::vector<Plane> planes_across_z(const std::vector<double>& heights) {
    std::vector<Plane> planes;
    for (const double z : heights) planes.push_back(make_plane({0, 0, z}, {0, 0, 1}));
    return planes;
}

/// The largest value of f 10 mm and more outside of a body, as far as some 100 mm from the middle.
inline double highest_outside(const ImplicitFunction& function, const std::function<double(const Vec3&)>& depth) {
    std::vector<Vec3> places;
    for (double x = -96; x <= 96; x += 6)
        for (double y = -96; y <= 96; y += 6)
            for (double z = -96; z <= 96; z += 6)
                if (depth({x, y, z}) < -10) places.push_back({x, y, z});
    std::vector<double> values(places.size());
    function.values(places, values);
    return std::ranges::max(values);
}

}  // namespace kontur::test
