// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/points_on_edges.h"

namespace kontur {

Contour without_points_on_edges(const Contour& contour, double tolerance_mm) {
    const std::vector<Vec3>& points = contour.points;
    const std::size_t n = points.size();
    const auto at = [&](std::size_t i) { return points[i < n ? i : 0]; };
    // Whether all between two points lie on the edge from one to the other, one after another.
    const auto is_edge = [&](std::size_t first, std::size_t last) {
        const Vec3 along = normalized(at(last) - at(first));
        for (std::size_t i = first + 1; i < last; ++i)
            if (dot(at(i) - at(i - 1), along) <= 0 || distance_to_segment(at(i), at(first), at(last)) > tolerance_mm)
                return false;
        return dot(at(last) - at(last - 1), along) > 0;
    };
    const std::size_t end = contour.closed ? n : n - 1;
    // Longer and longer steps, then shorter ones: an edge of many points is not walked for each of them.
    const auto end_of_edge = [&](std::size_t first) {
        std::size_t last = first + 1, step = 1;
        for (; last + step <= end && is_edge(first, last + step); step *= 2) last += step;
        while ((step /= 2) > 0)
            if (last + step <= end && is_edge(first, last + step)) last += step;
        return last;
    };
    Contour result = contour;
    result.points.clear();
    for (std::size_t first = 0; first < end; first = end_of_edge(first)) result.points.push_back(points[first]);
    if (!contour.closed) result.points.push_back(points.back());
    return contour.closed && result.points.size() < 3 ? contour : result;
}

}  // namespace kontur
