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
    const double wanted = least_segments > 0 ? std::min(average, total / least_segments) : average;

    Contour subdivided = contour;
    subdivided.points.clear();
    for (std::size_t i = 0; i < segments; ++i) {
        const Vec3 &from = contour.points[i], &to = contour.points[(i + 1) % n];
        const double length = distance(from, to);
        const auto pieces = length > 2 * wanted ? static_cast<int>(std::round(length / wanted)) : 1;
        for (int piece = 0; piece < pieces; ++piece)
            subdivided.points.push_back(from + (to - from) * (double(piece) / pieces));
    }
    if (!contour.closed) subdivided.points.push_back(contour.points.back());
    return subdivided;
}

}  // namespace kontur
