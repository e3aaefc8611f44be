// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/extents.h"

#include <algorithm>

namespace kontur {
namespace {

constexpr double kWidths = 50;  // radii of a contour that its part of the drawing may have, where nothing wider is near
constexpr double kNear = 3;     // radii of a wider one, up to which it counts there, less and less
constexpr double kLeast = 1e-4;

}  // namespace

Extents::Extents(const ContourSet& drawn, const Ball3& ball) : whole_mm_(ball.radius) {
    for (const Contour& contour : drawn.contours) contours_.push_back(smallest_ball(contour.points));
    std::stable_sort(contours_.begin(), contours_.end(), [](const Ball3& a, const Ball3& b) { return a.radius > b.radius; });
    is_one_part_ = std::ranges::all_of(contours_, [&](const Ball3& contour) { return at(contour.center) == 1; });
}

double Extents::at(const Vec3& place) const {
    double nearest = whole_mm_, shown = 0;
    for (const Ball3& contour : contours_) {
        const double apart = std::max(0.0, distance(contour.center, place) - contour.radius);
        nearest = std::min(nearest, apart);
        shown = std::max(shown, kWidths * (contour.radius - apart / kNear));
        if (shown >= whole_mm_) return 1;
    }
    return std::clamp(std::max(shown, nearest) / whole_mm_, kLeast, 1.0);
}

}  // namespace kontur
