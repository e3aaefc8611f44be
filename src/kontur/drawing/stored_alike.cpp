// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/stored_alike.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "kontur/drawing/ring_starts.h"

namespace kontur {
namespace {

Vec3 middle_of(const Contour& contour) {
    Vec3 middle;
    for (const Vec3& p : contour.points) middle += p / static_cast<double>(contour.points.size());
    return middle;
}

void begin_all_alike(ContourSet& set, const Ball3& ball) {
    for (Contour& contour : set.contours) begin_alike(contour, ball);
}

using Key = std::array<double, 5>;

/// Contours that begin alike, by their length.
Affine3 frame_by_longest(const ContourSet& set, const Ball3& ball) {
    const auto key = [&](const Contour& contour) {
        const Vec3& first = contour.points.front();
        return Key{-rounded(line_length(contour.points, contour.closed), ball),
                   rounded(distance(middle_of(contour), ball.center), ball), first.x, first.y, first.z};
    };
    Affine3 frame;
    const auto longest = std::ranges::min_element(set.contours, {}, key);
    if (longest == set.contours.end() || !(ball.radius > 0)) return frame;
    const Vec3 middle = middle_of(*longest), first = longest->points.front() - middle;
    Vec3 turning;  // twice the area on whose left side the line runs
    for (std::size_t i = 1; i < longest->points.size(); ++i)
        turning += cross(longest->points[i - 1] - middle, longest->points[i] - middle);
    const Vec3 z = dot(turning, longest->plane.normal) < 0 ? -longest->plane.normal : longest->plane.normal;
    const Vec3 x = normalized(first - dot(first, z) * z);
    if (x == Vec3{}) return frame;
    frame.set_column(0, x);
    frame.set_column(1, cross(z, x));
    frame.set_column(2, z);
    frame.translation = middle;
    return frame;
}

}  // namespace

Affine3 frame_of(const ContourSet& contours) {
    ContourSet set;
    set.contours = contours.contours;
    const Ball3 ball = smallest_ball(set);
    begin_all_alike(set, ball);
    return frame_by_longest(set, ball);
}

ContourSet stored_alike(ContourSet set) {
    const Ball3 ball = smallest_ball(set);
    begin_all_alike(set, ball);
    const Affine3 to_frame = frame_by_longest(set, ball).inverse();
    std::vector<std::pair<Key, Contour>> contours;
    for (Contour& contour : set.contours) {
        const Vec3 middle = to_frame.apply(middle_of(contour));
        const Key key{rounded(middle.z, ball), rounded(middle.y, ball), rounded(middle.x, ball), contour.points.front().x,
                      contour.points.front().y};
        contours.emplace_back(key, std::move(contour));
    }
    std::ranges::stable_sort(contours, {}, [](const auto& one) { return one.first; });
    for (std::size_t c = 0; c < contours.size(); ++c) set.contours[c] = std::move(contours[c].second);
    return set;
}

}  // namespace kontur
