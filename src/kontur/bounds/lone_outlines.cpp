// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/lone_outlines.h"

#include <fmt/format.h>

#include <algorithm>

#include "kontur/base/counted.h"

namespace kontur {
namespace {

// Of the area of all outlines. Of 256 organ drawings, 2 of a thin vessel by hand are above it. Half names one more organ,
// .07 of which stands alone; twice is silent on the linked rings, of which .17 does.
constexpr double kShare = 0.1;

/// Whether a line of another section crosses a part's plane in it or near it.
bool is_crossed(const DrawnRegion& own, const RegionPart& part, const Section& other) {
    return std::ranges::any_of(crossings_with(own.section.plane, other), [&](const Point2& at) {
        const Section::Nearest nearest = own.search.nearest(at);
        return nearest.outline == part.outline() && nearest.distance < kNearest * part.radius_mm;
    });
}

bool stands_alone(const std::vector<DrawnRegion>& regions, const std::vector<TubeWay>& ways, const RegionPart& part) {
    const auto is_part = [&](const RegionPart& end) { return end.region == part.region && end.outline() == part.outline(); };
    if (std::ranges::any_of(ways, [&](const TubeWay& way) { return is_part(way.from) || is_part(way.to); })) return false;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        if (r == part.region) continue;
        bool is_near = false;
        regions[r].places.visit_within(part.center, kNearest * std::max(part.radius_mm, regions[r].radius_mm),
                                       [&](const Vec3&) { is_near = true; });
        if (is_near || is_crossed(regions[part.region], part, regions[r].section)) return false;
    }
    return true;
}

}  // namespace

std::optional<std::string> lone_outlines_note(const std::vector<DrawnRegion>& regions, const std::vector<TubeWay>& ways) {
    if (regions.size() < 2) return {};
    const std::vector<RegionPart> parts = region_parts(regions);
    const RegionPart* first = nullptr;
    std::size_t count = 0;
    double lone = 0, all = 0;  // squares of radii, as areas are
    for (const RegionPart& part : parts) {
        const double square = part.radius_mm * part.radius_mm;
        all += square;
        if (!stands_alone(regions, ways, part)) continue;
        lone += square;
        ++count;
        if (!first) first = &part;
    }
    if (!first || lone < kShare * all) return {};
    return fmt::format(
        "{} of {} stand{} alone, the first of them contour {}: no other lies near, and how the object goes on "
        "from there is a guess; a contour across them would say it",
        count, counted(parts.size(), "outline"), count == 1 ? "s" : "",
        regions[first->region].section.contours[first->outline()] + 1);
}

}  // namespace kontur
