// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/borrowed_borders.h"

#include <cmath>
#include <optional>

#include "kontur/labels/filled_map.h"
#include "kontur/labels/union_contours.h"

namespace kontur {
namespace {

/// What borders on the points of a contour of `owner`: for each the other structure whose surface is nearest, if that is
/// nearer than the union's.
std::vector<std::optional<std::size_t>> neighbours_at(const std::vector<Vec3>& points, std::size_t owner,
                                                      const Neighbours& neighbours, const Work& work) {
    std::vector<double> nearest = depths_mm(*neighbours.all, points, work);
    std::vector<std::optional<std::size_t>> found(points.size());
    for (std::size_t other = 0; other < neighbours.functions.size(); ++other) {
        if (other == owner) continue;
        const std::vector<double> depths = depths_mm(*neighbours.functions[other], points, work);
        for (std::size_t n = 0; n < points.size(); ++n)
            if (std::abs(depths[n]) < nearest[n]) nearest[n] = std::abs(depths[n]), found[n] = other;
    }
    return found;
}

}  // namespace

std::vector<std::vector<SurfacePoint>> borrowed_borders(const Neighbours& neighbours, const Work& work) {
    std::vector<std::vector<SurfacePoint>> borrowed(neighbours.drawn.size());
    for (std::size_t owner = 0; owner < neighbours.drawn.size(); ++owner)
        for (const Contour& contour : neighbours.drawn[owner]->contours) {
            const auto is_silent = [&](std::size_t structure) {
                return !is_drawn_in(*neighbours.drawn[structure], contour.plane);
            };
            bool is_any_silent = false;
            for (std::size_t n = 0; n < neighbours.drawn.size(); ++n) is_any_silent = is_any_silent || is_silent(n);
            if (!is_any_silent) continue;
            const auto beside = neighbours_at(contour.points, owner, neighbours, work);
            for (std::size_t n = 0; n < beside.size(); ++n)
                if (beside[n] && is_silent(*beside[n])) borrowed[*beside[n]].push_back({contour.points[n], {}});
        }
    return borrowed;
}

}  // namespace kontur
