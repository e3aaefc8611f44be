// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/section.h"

#include <algorithm>
#include <cmath>

#include "kontur/shape/contour_nesting.h"

namespace kontur {

bool Section::contains(const Point2& p) const {
    bool inside = false;
    for (const Polygon2& outline : outlines) inside ^= is_inside(outline, p);
    return inside;
}

Section::Nearest Section::nearest(const Point2& p) const {
    double nearest2 = std::numeric_limits<double>::infinity();
    Nearest result;
    for (std::size_t o = 0; o < outlines.size(); ++o) {
        const Polygon2& outline = outlines[o];
        for (std::size_t i = 0, before = outline.size() - 1; i < outline.size(); before = i++) {
            const Point2 &a = outline[before], &b = outline[i];
            const double ux = b[0] - a[0], uy = b[1] - a[1], px = p[0] - a[0], py = p[1] - a[1];
            const double length2 = ux * ux + uy * uy;
            const double t = length2 > 0 ? std::clamp((px * ux + py * uy) / length2, 0.0, 1.0) : 0.0;
            const double dx = px - t * ux, dy = py - t * uy;
            if (dx * dx + dy * dy >= nearest2) continue;
            nearest2 = dx * dx + dy * dy;
            result = {0, {a[0] + t * ux, a[1] + t * uy}, o};
        }
    }
    result.distance = std::sqrt(nearest2);
    return result;
}

std::vector<Section> sections_of(const ContourSet& set, double tolerance_mm) {
    std::vector<Section> sections;
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        const Contour& contour = set.contours[c];
        if (!contour.closed) continue;
        auto found = std::find_if(sections.begin(), sections.end(),
                                  [&](const Section& s) { return coincide(s.plane, contour.plane, tolerance_mm); });
        if (found == sections.end()) found = sections.insert(found, {contour.plane, {}, {}});
        found->contours.push_back(c);
        Polygon2& outline = found->outlines.emplace_back();
        for (const Vec3& p : contour.points) outline.push_back(found->plane.to_uv(p));
    }
    return sections;
}

}  // namespace kontur
