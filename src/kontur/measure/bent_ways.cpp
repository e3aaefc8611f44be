// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/bent_ways.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "kontur/base/turn.h"

namespace kontur {
namespace {

Point2 centroid(const Polygon2& outline) {
    double twice = 0;
    Point2 sum{};
    const Point2 origin = outline.front();
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point2 &p = outline[i], &q = outline[(i + 1) % outline.size()];
        const double ax = p[0] - origin[0], ay = p[1] - origin[1], bx = q[0] - origin[0], by = q[1] - origin[1];
        const double part = ax * by - bx * ay;
        twice += part;
        sum[0] += part * (ax + bx);
        sum[1] += part * (ay + by);
    }
    if (twice == 0) return origin;
    return {origin[0] + sum[0] / (3 * twice), origin[1] + sum[1] / (3 * twice)};
}

std::vector<Ring> rings_of(std::span<const Section* const> sections) {
    std::vector<Ring> rings;
    for (std::size_t s = 0; s < sections.size(); ++s) {
        if (!sections[s]) continue;
        const Section& section = *sections[s];
        for (std::size_t o = 0; o < section.outlines.size(); ++o) {
            const Polygon2& outline = section.outlines[o];
            if (section.layer(o) < 1 || outline.size() < 3) continue;
            rings.push_back({s, section.contours[o], section.plane.from_uv(centroid(outline)), section.plane.normal,
                             std::sqrt(area(outline) / std::numbers::pi)});
        }
    }
    return rings;
}

/// From a ring's middle to places inside of it.
std::vector<Vec3> offsets(const Ring& ring, const Section& section) {
    constexpr std::size_t kPlaces = 12;
    constexpr double kInside = 0.6;  // of the way from the middle to the outline
    std::vector<Vec3> result;
    for (std::size_t o = 0; o < section.outlines.size(); ++o) {
        if (section.contours[o] != ring.contour) continue;
        const Polygon2& outline = section.outlines[o];
        const std::size_t stride = outline.size() / kPlaces + 1;
        for (std::size_t i = 0; i < outline.size(); i += stride)
            result.push_back(kInside * (section.plane.from_uv(outline[i]) - ring.middle));
    }
    return result;
}

/// The nearest ring ahead along `sign` times the normal.
std::optional<std::size_t> next_ring(const std::vector<Ring>& rings, std::size_t own, double sign) {
    constexpr double kLeastCosine = std::numbers::sqrt2 / 2;
    std::optional<std::size_t> next;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t other = 0; other < rings.size(); ++other) {
        if (rings[other].section == rings[own].section) continue;
        const Vec3 way = rings[other].middle - rings[own].middle;
        const double length = norm(way);
        if (!(length > 0 && length < nearest)) continue;
        if (sign * dot(way, rings[own].normal) < kLeastCosine * length) continue;
        if (std::abs(dot(way, rings[other].normal)) < kLeastCosine * length) continue;
        nearest = length;
        next = other;
    }
    return next;
}

bool may_be_one_tube(const Ring& a, const Ring& b) {
    constexpr double kLeastRadii = 3, kMostRatio = 2;
    const auto [thin, thick] = std::minmax({a.radius_mm, b.radius_mm});
    return thick < kMostRatio * thin && distance(a.middle, b.middle) > kLeastRadii * thick;
}

/// Along the cubic whose ends lie in the rings' middles and run along their normals.
BentWays ways_between(const Ring& a, const Ring& b, const Section& section) {
    const Vec3 way = b.middle - a.middle;
    const double length = norm(way);
    const Vec3 first = (dot(way, a.normal) < 0 ? -1.0 : 1.0) * a.normal,
               last = (dot(way, b.normal) < 0 ? -1.0 : 1.0) * b.normal;
    const std::vector<Vec3> places = offsets(a, section);
    BentWays ways{a.section, b.section, a.contour, b.contour, length, way / length, {}};
    ways.places.resize(places.size());
    for (std::size_t q = 0; q < kQuarters.size(); ++q) {
        const double t = kQuarters[q], s = 1 - t;
        const Vec3 middle =
            s * s * (1 + 2 * t) * a.middle + t * t * (3 - 2 * t) * b.middle + length * t * s * (s * first - t * last);
        const Vec3 along = normalized(6 * t * s * way + length * (s * (1 - 3 * t) * first + t * (3 * t - 2) * last));
        const double scale = s + t * b.radius_mm / a.radius_mm;
        for (std::size_t n = 0; n < places.size(); ++n) ways.places[n][q] = middle + scale * turned(places[n], first, along);
    }
    return ways;
}

}  // namespace

std::vector<std::pair<Ring, Ring>> ring_pairs(std::span<const Section* const> sections) {
    const std::vector<Ring> rings = rings_of(sections);
    std::vector<std::pair<Ring, Ring>> result;
    for (std::size_t own = 0; own < rings.size(); ++own)
        for (const double sign : {1.0, -1.0}) {
            const auto next = next_ring(rings, own, sign);
            if (!next || *next < own) continue;
            const double back = dot(rings[own].middle - rings[*next].middle, rings[*next].normal) < 0 ? -1 : 1;
            if (next_ring(rings, *next, back) == own && may_be_one_tube(rings[own], rings[*next]))
                result.emplace_back(rings[own], rings[*next]);
        }
    return result;
}

std::vector<BentWays> bent_ways(std::span<const PlaneLook> looks) {
    std::vector<const Section*> sections;
    for (const PlaneLook& look : looks) sections.push_back(look.section());
    std::vector<BentWays> result;
    for (const auto& [own, next] : ring_pairs(sections)) result.push_back(ways_between(own, next, *sections[own.section]));
    return result;
}

}  // namespace kontur
