// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/proposed_lines.h"

#include <algorithm>

#include "kontur/shape/section.h"

namespace kontur::viewer {

std::vector<Polyline> proposed_lines(const TriangleMesh& mesh, const Plane& plane) {
    constexpr double kSpeck = 0.01;
    std::vector<Polyline> lines = outline(mesh, plane);
    const auto enclosed = [&](const Polyline& line) {
        Polygon2 polygon;
        for (const Vec3& p : line.points) polygon.push_back(plane.to_uv(p));
        return area(polygon);
    };
    double largest = 0;
    for (const Polyline& line : lines) largest = std::max(largest, enclosed(line));
    std::erase_if(lines, [&](const Polyline& line) { return enclosed(line) < kSpeck * largest; });
    return lines;
}

}  // namespace kontur::viewer
