// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/seen_inside.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace kontur {
namespace {

constexpr double kMost = 0.5;
constexpr double kLeastSine = 0.0087;  // half a degree: planes that cross less have no common line

/// How much of a way, or of an area, was looked at, and how much of that is object.
struct Share {
    double object = 0, all = 0;

    double value() const { return object / all; }
    Seen seen() const { return all == 0 ? Seen::nothing : value() > kMost ? Seen::object : Seen::no_object; }
};

/// Along the ways of another plane through what the outline encloses.
void look_along(const Section& outline, const Section& other, Share& share) {
    constexpr int kPlaces = 16;
    const Vec3 direction = cross(outline.plane.normal, other.plane.normal);
    if (norm(direction) < kLeastSine) return;
    std::vector<Vec3> passed;
    for_each_edge(outline.outlines.front(), [&](const Point2& from, const Point2& to) {
        const Vec3 a = outline.plane.from_uv(from), b = outline.plane.from_uv(to);
        const double before = other.plane.distance_to(a), after = other.plane.distance_to(b);
        if ((before >= 0) != (after >= 0)) passed.push_back(a + before / (before - after) * (b - a));
    });
    std::ranges::sort(passed, {}, [&](const Vec3& p) { return dot(p, direction); });
    for (std::size_t i = 0; i + 1 < passed.size(); i += 2)
        for (int place = 0; place < kPlaces; ++place) {
            const Vec3 at = passed[i] + (place + 0.5) / kPlaces * (passed[i + 1] - passed[i]);
            const double weight = distance(passed[i], passed[i + 1]) / kPlaces;
            share.all += weight;
            if (other.contains(other.plane.to_uv(at))) share.object += weight;
        }
}

/// Over what the outline encloses, straight above it in a parallel plane.
Share look_across(const Section& outline, const Section& other) {
    constexpr int kPlaces = 24;  // each way
    const Polygon2& line = outline.outlines.front();
    Box2 box;
    for (const Point2& p : line) box.extend(p);
    const double slant = dot(outline.plane.normal, other.plane.normal);
    Share share;
    for (int row = 0; row < kPlaces; ++row)
        for (int column = 0; column < kPlaces; ++column) {
            const auto along = [&](std::size_t axis, int n) {
                return box.low[axis] + (n + 0.5) / kPlaces * (box.high[axis] - box.low[axis]);
            };
            const Point2 at{along(0, column), along(1, row)};
            if (!is_inside(line, at)) continue;
            const Vec3 place = outline.plane.from_uv(at);
            const Vec3 above = place - other.plane.distance_to(place) / slant * outline.plane.normal;
            share.all += 1;
            if (other.contains(other.plane.to_uv(above))) share.object += 1;
        }
    return share;
}

/// The next parallel plane on one side of an outline's.
const Section* next_parallel(const Section& outline, const std::vector<Section>& sections, std::size_t own, double sign) {
    const Section* next = nullptr;
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (const Section& other : sections) {
        if (&other == &sections[own] || !are_parallel(outline.plane, other.plane)) continue;
        const double ahead = sign * outline.plane.distance_to(other.plane.origin);
        if (ahead > 0 && ahead < nearest_mm) nearest_mm = ahead, next = &other;
    }
    return next;
}

/// On one side of an outline's plane: what the next plane shows, or the one behind it if that is doubtful, and over which
/// depth those behind it go on to show it.
struct Beyond {
    bool is_over_a_doubt = false;
    Seen shown = Seen::nothing;
    double depth_mm = 0;
};

Beyond look_beyond(const Section& outline, const std::vector<Section>& sections, std::size_t own,
                   const std::vector<bool>& doubtful, double sign) {
    std::vector<std::pair<double, std::size_t>> ahead;
    for (std::size_t s = 0; s < sections.size(); ++s)
        if (s != own && are_parallel(outline.plane, sections[s].plane))
            if (const double mm = sign * outline.plane.distance_to(sections[s].plane.origin); mm > 0)
                ahead.emplace_back(mm, s);
    std::ranges::sort(ahead);
    Beyond beyond;
    beyond.is_over_a_doubt = !ahead.empty() && doubtful[ahead.front().second];
    if (beyond.is_over_a_doubt) ahead.erase(ahead.begin());
    for (const auto& [mm, s] : ahead) {
        const Seen seen = doubtful[s] ? Seen::no_object : look_across(outline, sections[s]).seen();  // it may be one
        if (s == ahead.front().second) beyond.shown = seen;
        if (seen != beyond.shown) break;
        beyond.depth_mm = mm - ahead.front().first;
    }
    return beyond;
}

}  // namespace

Seen seen_inside(const Contour& contour, const std::vector<Section>& sections, std::size_t own) {
    const Section outline = section_of(contour, sections[own].plane);
    Share along;
    for (const Section& other : sections)
        if (&other != &sections[own]) look_along(outline, other, along);
    if (along.all > 0) return along.seen();
    const Section *before = next_parallel(outline, sections, own, -1), *behind = next_parallel(outline, sections, own, 1);
    if (!before || !behind) return Seen::nothing;
    const Seen one = look_across(outline, *before).seen();
    return one == look_across(outline, *behind).seen() ? one : Seen::nothing;
}

Seen seen_beyond(const Contour& contour, const std::vector<Section>& sections, std::size_t own,
                 const std::vector<bool>& doubtful, double wall_mm) {
    constexpr double kWalls = 3;
    const Section outline = section_of(contour, sections[own].plane);
    const Beyond before = look_beyond(outline, sections, own, doubtful, -1),
                 behind = look_beyond(outline, sections, own, doubtful, 1);
    if (before.shown == Seen::no_object || behind.shown == Seen::no_object) return Seen::nothing;
    if (before.is_over_a_doubt && behind.is_over_a_doubt) return Seen::nothing;
    const auto is_solid = [&](const Beyond& side) {
        return side.shown == Seen::object && side.depth_mm >= kWalls * wall_mm;
    };
    return is_solid(before) || is_solid(behind) ? Seen::object : Seen::nothing;
}

}  // namespace kontur
