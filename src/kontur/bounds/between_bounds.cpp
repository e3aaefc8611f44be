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
constexpr std::size_t kMostProbes = 40;

bool others_show_nothing(const std::vector<DrawnRegion>& regions, const TubeWay& way, const Vec3& place) {
    for (std::size_t r = 0; r < regions.size(); ++r) {
        if (r == way.from.region || r == way.to.region) continue;
        const Plane& plane = regions[r].section.plane;
        if (std::abs(plane.distance_to(place)) > kNearby * way.length_mm) continue;
        const Point2 at = plane.to_uv(place);
        if (!regions[r].search.contains(at) && regions[r].search.clearance(at) < way.length_mm) return true;
    }
    return false;
}

void append(const std::vector<DrawnRegion>& regions, const TubeWay& way, std::vector<Bound>& bounds) {
    const DrawnRegion &here = regions[way.from.region], &there = regions[way.to.region];
    const std::size_t stride = std::max<std::size_t>(1, way.from.probes.size() / kMostProbes);
    for (std::size_t i = 0; i < way.from.probes.size(); i += stride) {
        const Vec3 off = here.section.plane.from_uv(way.from.probes[i].at) - way.from.center;
        const Vec3 off_there = way.to.radius_mm / way.from.radius_mm * turned(off, way.leaves, way.enters);
        const Point2 at = there.section.plane.to_uv(way.to.center + off_there);
        if (!there.search.contains(at)) continue;
        const double depth = std::min(way.from.probes[i].depth, there.search.clearance(at));
        const Vec3 place = way.middle() + 0.5 * (off + off_there);
        if (!others_show_nothing(regions, way, place))
            bounds.push_back({.position = place,
                              .least_mm = kValue * depth,
                              .noise_mm = faded(kNoise * depth, way.belief),
                              .by_side = true});
    }
}

}  // namespace

std::vector<Bound> between_bounds(const std::vector<DrawnRegion>& regions, const std::vector<TubeWay>& ways) {
    std::vector<Bound> bounds;
    for (const TubeWay& way : ways) append(regions, way, bounds);
    return bounds;
}

}  // namespace kontur
