// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/between_bounds.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/turn.h"

namespace kontur {
namespace {

// Of seven tubes and 30 drawings by few planes (tube_ways.cpp). kNoise: half or twice +-.001. kNearby: no tube, few planes
// at most .002.
constexpr double kValue = 0.35;  // of the depth; half leaves .01 of a straight tube away, twice makes one too thick by .03
constexpr double kNoise = 0.2;
constexpr double kNearby = 0.25;  // of the way: so near another plane knows
// Of a tube's radius: what its wall may stand out by. Of two arches and two straight tubes the mean Dice is .957; half .959,
// which leaves less to tubes that do widen.
constexpr double kBulge = 0.05;
constexpr std::size_t kWallSteps[] = {2, 4};  // places of the way: a quarter and half of it

bool others_show_nothing(const std::vector<DrawnRegion>& regions, const TubeWay& way, const Vec3& place) {
    for (std::size_t r = 0; r < regions.size(); ++r) {
        if (r == way.from.region || r == way.to.region) continue;
        const Plane& plane = regions[r].section.plane;
        if (std::abs(plane.distance_to(place)) > kNearby * way.length_mm) continue;
        const Point2 at = plane.to_uv(place);
        const double looked_at = 1 - (1 - kHidden) * way.hides(plane.normal);
        if (!regions[r].search.contains(at) && regions[r].search.clearance(at) < looked_at * way.length_mm) return true;
    }
    return false;
}

/// From a ring's outline half-way to the other ring: the tube is no wider there than both rings make it. Of ways that lead
/// on alone: where two sections stand by themselves, an organ is wider between them.
void append_walls(const std::vector<DrawnRegion>& regions, const TubeWay& way, bool is_back, std::vector<Bound>& bounds) {
    const RegionPart &from = is_back ? way.to : way.from, &to = is_back ? way.from : way.to;
    const DrawnRegion &here = regions[from.region], &there = regions[to.region];
    const Polygon2& line = here.section.outlines[from.outline()];
    const double belief = way.belief * way.chain;
    if (belief < kLeastBelief) return;
    const double radius = way.radius_mm(), scale = to.radius_mm / from.radius_mm;
    for_each_step(line, kLinePlaces, [&](const Point2& p) {
        const Vec3 off = here.section.plane.from_uv(p) - from.center;
        const Vec3 off_there = scale * (is_back ? turned(off, way.enters, way.leaves) : turned(off, way.leaves, way.enters));
        const Point2 at = there.section.plane.to_uv(to.center + off_there);
        const double flare = there.search.contains(at) ? there.search.clearance(at) : 0;
        for (const std::size_t step : kWallSteps) {
            const double part = static_cast<double>(step) / static_cast<double>(way.places.size() - 1);
            const Vec3& middle = way.places[is_back ? way.places.size() - 1 - step : step];
            const Vec3 place = middle + (1 - part) * off + part * off_there;
            bounds.push_back({.position = place,
                              .most_mm = part * flare + kBulge * radius,
                              .noise_mm = faded(kSureNoise * radius, belief)});
        }
    });
}

void append(const std::vector<DrawnRegion>& regions, const TubeWay& way, std::vector<Bound>& bounds) {
    const DrawnRegion &here = regions[way.from.region], &there = regions[way.to.region];
    for_each_step(way.from.probes, kLinePlaces, [&](const Probe& probe) {
        const Vec3 off = here.section.plane.from_uv(probe.at) - way.from.center;
        const Vec3 off_there = way.to.radius_mm / way.from.radius_mm * turned(off, way.leaves, way.enters);
        const Point2 at = there.section.plane.to_uv(way.to.center + off_there);
        if (!there.search.contains(at)) return;
        const double depth = std::min(probe.depth, there.search.clearance(at));
        const Vec3 place = way.middle() + 0.5 * (off + off_there);
        if (!others_show_nothing(regions, way, place))
            bounds.push_back({.position = place,
                              .least_mm = kValue * depth,
                              .noise_mm = faded(kNoise * depth, way.belief),
                              .by_side = true});
    });
}

}  // namespace

std::vector<Bound> between_bounds(const std::vector<DrawnRegion>& regions, const std::vector<TubeWay>& ways) {
    std::vector<Bound> bounds;
    for (const TubeWay& way : ways) {
        append(regions, way, bounds);
        for (const bool is_back : {false, true}) append_walls(regions, way, is_back, bounds);
    }
    return bounds;
}

}  // namespace kontur
