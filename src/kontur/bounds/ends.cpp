// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kontur/bounds/drawn_regions.h"
#include "kontur/drawing/drawn_planes.h"
#include "kontur/drawing/orient.h"
#include "kontur/drawing/subdivide.h"

namespace kontur {
namespace {

enum : std::int32_t { kBelowRim = 1, kInsideRim, kLid };  // lines of a contour that ends the object

/// The part of a section that one of its contours encloses, without the holes in it and the islands in those.
Section region_of(const ContourSet& set, const Section& section, std::size_t contour) {
    const auto own = std::find(section.contours.begin(), section.contours.end(), contour) - section.contours.begin();
    const Section outer{section.plane, {section.outlines[static_cast<std::size_t>(own)]}, {contour}, {false}};
    Section region = outer;
    for (std::size_t o = 0; o < section.outlines.size(); ++o)
        if (set.contours[section.contours[o]].hole && outer.contains(section.outlines[o].front())) {
            region.outlines.push_back(section.outlines[o]);
            region.contours.push_back(section.contours[o]);
            region.holes.push_back(true);
        }
    return region;
}

/// How the rest of the drawing continues a region on one side of its plane.
struct Continuation {
    bool carried_on = false;
    std::optional<double> spacing{};  ///< mm to the next parallel plane
    const Section* next = nullptr;    ///< what is drawn in it
};

Continuation continuation(const DrawnPlanes& planes, const Section& region, const std::vector<Probe>& inside, double sign) {
    Continuation result;
    for (const Section& other : planes.sections) {
        if (are_parallel(region.plane, other.plane)) continue;
        for (const Polygon2& outline : other.outlines)
            for (const Point2& p : outline) {
                const Vec3 at = other.plane.from_uv(p);
                if (sign * region.plane.distance_to(at) > planes.tolerance_mm && region.contains(region.plane.to_uv(at)))
                    result.carried_on = true;
            }
    }
    if (const auto next = planes.next(region.plane, sign)) {
        result.spacing = next->distance_mm;
        result.next = next->section;
        const Section& there = *next->section;
        for (const Probe& probe : inside) {
            const Vec3 at = region.plane.from_uv(probe.at) + sign * next->distance_mm * region.plane.normal;
            result.carried_on = result.carried_on || there.contains(there.plane.to_uv(at));
        }
    }
    return result;
}

/// Where no section lies over the region, the rest of the drawing is on the side that has planes, or the nearer ones.
/// 0 where neither side does.
double side_of_the_rest(const Continuation& above, const Continuation& below) {
    if (!above.next && !below.next) return 0;
    if (above.next && below.next) return *above.spacing < *below.spacing ? 1 : *below.spacing < *above.spacing ? -1 : 0;
    return above.next ? 1 : -1;
}

/// By how much a wall at a place of a flat end's rim moves outwards per mm below it: straight to the outline of the next
/// parallel plane; upright where there is none of its kind (outer or of a hole).
double flare(const Continuation& below, const Contour& contour, const Vec3& rim) {
    constexpr double kMostFlare = 1;
    if (!below.next) return 0;
    const Point2 at = below.next->plane.to_uv(rim);
    const Section::Nearest there = below.next->nearest(at);
    if (below.next->layer(there.outline) != (contour.hole ? -1 : 1)) return 0;
    return std::clamp((below.next->contains(at) ? 1 : -1) * there.distance / *below.spacing, -kMostFlare, kMostFlare);
}

/// Where a flat end lies and how its rim is drawn.
struct FlatEnd {
    const Section& region;
    const Continuation& below;  ///< what follows on the object's side
    Vec3 up;                    ///< unit, out of the object
    double edge_mm;             ///< from the rim to its copies
    Vec3 beyond;                ///< from the plane to the lid
};

/// Two copies of the contour: one below the rim, which says how the wall goes on there, and one inside of it on the lid.
/// Without them a smooth function, which has no edge, bulges on both sides of the rim.
void append_rim(const Contour& contour, std::int32_t index, const FlatEnd& end, Ends& ends) {
    const Contour rim = subdivide(contour, kLeastSegments);
    const ContourOrientation orientation = orient(rim);
    // One ring after the other, each a line of its own: points that alternate between them cannot be thinned along their
    // way.
    for (std::size_t i = 0; i < rim.points.size(); ++i)
        ends.lids.push_back(
            {.position =
                 rim.points[i] + end.edge_mm * (flare(end.below, contour, rim.points[i]) * orientation.normals[i] - end.up),
             .inplane_normal = orientation.normals[i],
             .plane_normal = rim.plane.normal,
             .contour = index,
             .line = kBelowRim,
             .on_ring = true});
    for (std::size_t i = 0; i < rim.points.size(); ++i) {
        const Vec3 inside = rim.points[i] - end.edge_mm * orientation.normals[i];
        const Point2 on_lid = end.region.plane.to_uv(inside);
        if (end.region.contains(on_lid) && end.region.clearance(on_lid) > 0.9 * end.edge_mm)
            ends.lids.push_back({.position = inside + end.beyond,
                                 .inplane_normal = end.up,
                                 .contour = index,
                                 .line = kInsideRim,
                                 .on_ring = true});
    }
}

/// `depth_mm`: of the deepest place in the region; `sign` says on which side of the plane the object ends.
FlatEnd flat_end(const DrawnPlanes& planes, const Section& region, const Continuation& below, double depth_mm, double sign) {
    constexpr double kEdge = 0.1, kBeyond = 0.005;  // of the inscribed radius
    constexpr double kLeastBeyond = 0.5;  // of the tolerance for planes: f is not so exact that it tells less from its plane
    const Vec3 up = sign * region.plane.normal;
    return {region, below, up, kEdge * depth_mm, std::max(kBeyond * depth_mm, kLeastBeyond * planes.tolerance_mm) * up};
}

void append_flat(const ContourSet& set, const FlatEnd& end, const std::vector<Probe>& inside, Ends& ends) {
    for (const std::size_t c : end.region.contours) append_rim(set.contours[c], static_cast<std::int32_t>(c), end, ends);
    const auto contour = static_cast<std::int32_t>(end.region.contours.front());
    for (const Probe& probe : inside)
        ends.lids.push_back({.position = end.region.plane.from_uv(probe.at) + end.beyond,
                             .inplane_normal = end.up,
                             .contour = contour,
                             .line = kLid});
}

void append_dome(const Section& region, const std::vector<Probe>& inside, double sign, double height, Ends& ends) {
    const auto contour = static_cast<std::int32_t>(region.contours.front());
    const double widest = deepest(inside);
    for (const Probe& probe : inside) {
        const double rim = 1 - probe.depth / widest;
        const Vec3 base = region.plane.from_uv(probe.at), up = sign * height * region.plane.normal;
        ends.lids.push_back({.position = base + std::sqrt(1 - rim * rim) * up, .contour = contour, .line = kLid});
        ends.guards.push_back({.position = base + 1.5 * up, .most_mm = -height / 4, .noise_mm = kSureNoise * height});
    }
}

std::string complaint(std::size_t contour, bool both_carried_on) {
    return fmt::format("contour {} ends the object, but {}; its end was ignored", contour + 1,
                       both_carried_on ? "contours on both sides carry it on" : "nothing says on which side it goes on");
}

}  // namespace

Ends find_ends(const DrawnPlanes& planes) {
    Ends ends;
    const ContourSet& set = planes.set;
    for (const Section& section : planes.sections)
        for (const std::size_t c : section.contours) {
            if (set.contours[c].end == ContourEnd::automatic) continue;
            const Section region = region_of(set, section, c);
            const std::vector<Probe> inside = probes(region);
            const Continuation above = continuation(planes, region, inside, 1);
            const Continuation below = continuation(planes, region, inside, -1);
            const bool is_clear = above.carried_on != below.carried_on;
            const double towards_rest = is_clear           ? (above.carried_on ? 1 : -1)
                                        : above.carried_on ? 0
                                                           : side_of_the_rest(above, below);
            if (towards_rest == 0) {
                ends.notes.push_back(complaint(c, above.carried_on));
                continue;
            }
            const double sign = -towards_rest;
            const Continuation& rest = towards_rest > 0 ? above : below;
            if (set.contours[c].end == ContourEnd::flat) {
                append_flat(set, flat_end(planes, region, rest, deepest(inside), sign), inside, ends);
                continue;
            }
            const double widest = deepest(inside);
            append_dome(region, inside, sign, std::min(rest.spacing.value_or(widest) / 2, widest), ends);
        }
    return ends;
}

}  // namespace kontur
