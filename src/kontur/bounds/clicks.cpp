// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/clicks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kontur/drawing/drawn_planes.h"

namespace kontur {
namespace {

/// The contours that a point contradicts most.
struct Conflict {
    double clearance_mm;  ///< in the plane, to the nearest contour
    std::size_t contour;
};

constexpr std::size_t kMostTold = 5;  // of a kind of points, so that other sentences are seen, too

enum class Side { interior, exterior, surface };

std::optional<Conflict> conflict(const Vec3& point, Side side, const std::vector<Section>& sections) {
    std::optional<Conflict> worst;
    for (const Section& section : sections) {
        const Point2 at = section.plane.to_uv(point);
        if (side != Side::surface && section.contains(at) == (side == Side::interior)) continue;
        const Section::Nearest nearest = section.nearest(at);
        if (nearest.distance < 2 * std::abs(section.plane.distance_to(point))) continue;
        if (!worst || nearest.distance > worst->clearance_mm)
            worst = Conflict{nearest.distance, section.contours[nearest.outline]};
    }
    return worst;
}

}  // namespace

std::vector<Bound> click_bounds(const ContourSet& set, double margin_mm) {
    std::vector<Bound> bounds;
    for (const Vec3& p : set.interior) bounds.push_back({.position = p, .least_mm = margin_mm});
    for (const Vec3& p : set.exterior) bounds.push_back({.position = p, .most_mm = -margin_mm});
    return bounds;
}

std::vector<std::string> contradictory_clicks(const DrawnPlanes& planes, double margin_mm) {
    const ContourSet& set = planes.set;
    std::vector<std::string> sentences;
    const auto check = [&](const std::vector<Vec3>& points, Side side, std::string_view kind, std::string_view where) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto found = conflict(points[i], side, planes.sections);
            if (!found || found->clearance_mm <= margin_mm) continue;
            if (++count <= kMostTold)
                sentences.push_back(fmt::format("{} point {} contradicts contour {}: it lies {:.3g} mm {}", kind, i + 1,
                                                found->contour + 1, found->clearance_mm, where));
        }
        if (count == kMostTold + 1) sentences.push_back(fmt::format("1 more {} point contradicts contours", kind));
        if (count > kMostTold + 1)
            sentences.push_back(fmt::format("{} more {} points contradict contours", count - kMostTold, kind));
    };
    check(set.interior, Side::interior, "interior", "on its outside");
    check(set.exterior, Side::exterior, "exterior", "on its inside");
    std::vector<Vec3> on_surface;
    for (const SurfacePoint& p : set.surface) on_surface.push_back(p.position);
    check(on_surface, Side::surface, "surface", "from its line");
    for (std::size_t i = 0; i < set.interior.size(); ++i)
        for (std::size_t e = 0; e < set.exterior.size(); ++e)
            if (const double apart = distance(set.interior[i], set.exterior[e]); apart < margin_mm)
                sentences.push_back(
                    fmt::format("interior point {} and exterior point {} contradict each other: they are "
                                "{:.3g} mm apart",
                                i + 1, e + 1, apart));
    return sentences;
}

}  // namespace kontur
