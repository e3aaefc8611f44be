// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/asked_before.h"

#include <algorithm>

#include "kontur/base/point_tree.h"

namespace kontur {
namespace {

constexpr double kTold = 0.7;  // of the error without the image: where more is left, it said next to nothing

bool is_same(const Contour& a, const Contour& b) {
    return a.points == b.points && a.closed == b.closed && a.hole == b.hole && a.inside == b.inside;
}

bool holds(const ContourSet& set, const Contour& contour) {
    return std::any_of(set.contours.begin(), set.contours.end(), [&](const Contour& c) { return is_same(c, contour); });
}

void append(std::vector<Vec3>& points, const Contour& contour) {
    points.insert(points.end(), contour.points.begin(), contour.points.end());
}

}  // namespace

std::vector<Vec3> AskedBefore::still_shown(const ContourSet& edited) const {
    if (asked_.empty()) return {};
    std::vector<Vec3> same, changed;
    for (const Contour& contour : edited.contours) append(holds(contours_, contour) ? same : changed, contour);
    for (const Contour& contour : contours_.contours)
        if (!holds(edited, contour)) append(changed, contour);
    const PointTree same_lines(std::move(same)), changed_lines(std::move(changed));
    std::vector<Vec3> shown;
    for (const AskedPoint& asked : asked_) {
        const bool is_told = asked.share <= kTold;
        if (is_told && same_lines.distance_to(asked.position) < changed_lines.distance_to(asked.position))
            shown.push_back(asked.position);
    }
    return shown;
}

}  // namespace kontur
