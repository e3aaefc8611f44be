// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/subdivide.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/checks.h"

namespace kontur {

Contour subdivide(const Contour& contour, int least_segments) {
    check_at_least("the least number of segments", least_segments, 0);
    const std::size_t n = contour.points.size(), segments = contour.closed ? n : n - 1;
    if (n < 2) return contour;
    const double total = line_length(contour.points, contour.closed);
    const double average = total / static_cast<double>(segments);
    const double spacing = least_segments > 0 ? std::min(average, total / least_segments) : average;

    Contour result = contour;
    result.points.clear();
    for (std::size_t i = 0; i < segments; ++i) {
        const Vec3 &from = contour.points[i], &to = contour.points[(i + 1) % n];
        const double length = distance(from, to);
        const auto pieces = length > 2 * spacing ? static_cast<int>(std::round(length / spacing)) : 1;
        for (int piece = 0; piece < pieces; ++piece) result.points.push_back(from + (to - from) * (double(piece) / pieces));
    }
    if (!contour.closed) result.points.push_back(contour.points.back());
    return result;
}

}  // namespace kontur
