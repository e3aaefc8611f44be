// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "support/lobed_body.h"
#include "support/mask_of.h"

namespace kontur::test {

/// Positive inside a ball of radius 25 mm from which two horns, 6 mm in radius, lead up and bend outwards.
inline double horned_depth(const Vec3& p) {
    double depth = 25 - norm(p);
    for (const double side : {-1.0, 1.0}) {
        const Vec3 foot{12 * side, 0, 12}, bend{15 * side, 0, 30}, tip{24 * side, 0, 38};
        depth = std::max({depth, 6 - distance_to_segment(p, foot, bend), 6 - distance_to_segment(p, bend, tip)});
    }
    return depth;
}

inline double horned_look(const Vec3& p) { return two_tissues(horned_depth(p)); }

/// One across both horns, one along one of them; their tips are in none.
inline std::vector<Plane> planes_of_horns() {
    return {make_plane({0, 0, -11}, {0, 0, 1}), make_plane({0, 0, 6}, {0, 0, 1}), make_plane({0, 0, 27.5}, {0, 0, 1}),
            make_plane({14.5, 0, 0}, {1, 0, 0}), make_plane({0, -10, 0}, {0, 1, 0})};
}

/// Cut from voxels of 1 mm.
inline ContourSet cut(const std::vector<Plane>& planes, const std::function<double(const Vec3&)>& depth) {
    const Mask mask = mask_of(cube_grid(1), [&](const Vec3& p) { return depth(p) > 0; });
    return trace(mask, planes, {.min_area_mm2 = 2}, {});
}

inline ContourSet drawn_horns() { return cut(planes_of_horns(), horned_depth); }

/// Voxels of the body that are on the wrong side of f, over all that are inside.
inline double wrong_share(const ImplicitFunction& function, const Grid& grid,
                          const std::function<double(const Vec3&)>& depth) {
    std::vector<Vec3> centers;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) centers.push_back(grid.center_mm(i, j, k));
    std::vector<double> values(centers.size());
    function.values(centers, values);
    double wrong = 0, inside = 0;
    for (std::size_t n = 0; n < centers.size(); ++n) {
        const bool is_inside = depth(centers[n]) > 0;
        inside += is_inside;
        wrong += (values[n] > 0) != is_inside;
    }
    return wrong / inside;
}

}  // namespace kontur::test
