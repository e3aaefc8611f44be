// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/image_memory.h"

#include <algorithm>

#include "kontur/base/point_tree.h"

namespace kontur {
namespace {

constexpr double kMostShare = 0.7;  // of the error without the image: where more is left, it said next to nothing

bool is_same(const Contour& a, const Contour& b) {
    return a.points == b.points && a.closed == b.closed && a.hole == b.hole && a.inside == b.inside;
}

bool contains(const ContourSet& set, const Contour& contour) {
    return std::any_of(set.contours.begin(), set.contours.end(), [&](const Contour& c) { return is_same(c, contour); });
}

void append(std::vector<Vec3>& points, const Contour& contour) {
    points.insert(points.end(), contour.points.begin(), contour.points.end());
}

}  // namespace

std::vector<Vec3> ImageMemory::places_in(const ContourSet& set) const {
    if (shares_.empty()) return {};
    std::vector<Vec3> same, differing;
    for (const Contour& contour : set.contours) append(contains(contours_, contour) ? same : differing, contour);
    for (const Contour& contour : contours_.contours)
        if (!contains(set, contour)) append(differing, contour);
    const PointTree same_lines(std::move(same)), differing_lines(std::move(differing));
    std::vector<Vec3> places;
    for (const ImageShare& image : shares_)
        if (image.share <= kMostShare &&
            same_lines.distance_to(image.position) < differing_lines.distance_to(image.position))
            places.push_back(image.position);
    return places;
}

}  // namespace kontur
