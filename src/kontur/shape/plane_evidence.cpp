// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/plane_evidence.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace kontur {
namespace {

constexpr double kLeastSine = 0.0087;  // half a degree: planes that cross less have no common line

/// How much of a way, or of an area, was looked at, and how much of that is object.
struct Share {
    double object = 0, all = 0;

    double value() const { return object / all; }
    PlaneEvidence evidence() const {
        return all == 0 ? PlaneEvidence::nothing : value() > 0.5 ? PlaneEvidence::object : PlaneEvidence::no_object;
    }
};

/// Along the ways of another plane through what the outline encloses.
void look_along(const Section& outline, const Section& other, Share& share) {
    constexpr int kPlaces = 16;
    const Vec3 direction = cross(outline.plane.normal, other.plane.normal);
    if (norm(direction) < kLeastSine) return;
    std::vector<Vec3> passages;
    for_each_edge(outline.outlines.front(), [&](const Point2& from, const Point2& to) {
        const Vec3 a = outline.plane.from_uv(from), b = outline.plane.from_uv(to);
        const double before = other.plane.distance_to(a), after = other.plane.distance_to(b);
        if ((before >= 0) != (after >= 0)) passages.push_back(a + before / (before - after) * (b - a));
    });
    std::ranges::sort(passages, {}, [&](const Vec3& p) { return dot(p, direction); });
    for (std::size_t i = 0; i + 1 < passages.size(); i += 2)
        for (int place = 0; place < kPlaces; ++place) {
            const Vec3 at = passages[i] + (place + 0.5) / kPlaces * (passages[i + 1] - passages[i]);
            const double weight = distance(passages[i], passages[i + 1]) / kPlaces;
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
    PlaneEvidence evidence = PlaneEvidence::nothing;
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
        const PlaneEvidence evidence =
            doubtful[s] ? PlaneEvidence::no_object : look_across(outline, sections[s]).evidence();  // it may be one
        if (s == ahead.front().second) beyond.evidence = evidence;
        if (evidence != beyond.evidence) break;
        beyond.depth_mm = mm - ahead.front().first;
    }
    return beyond;
}

}  // namespace

PlaneEvidence evidence_inside(const Contour& contour, const std::vector<Section>& sections, std::size_t own) {
    const Section outline = section_of(contour, sections[own].plane);
    Share along;
    for (const Section& other : sections)
        if (&other != &sections[own]) look_along(outline, other, along);
    if (along.all > 0) return along.evidence();
    const Section *before = next_parallel(outline, sections, own, -1), *behind = next_parallel(outline, sections, own, 1);
    if (!before || !behind) return PlaneEvidence::nothing;
    const PlaneEvidence one = look_across(outline, *before).evidence();
    return one == look_across(outline, *behind).evidence() ? one : PlaneEvidence::nothing;
}

PlaneEvidence evidence_beyond(const Contour& contour, const std::vector<Section>& sections, std::size_t own,
                              const std::vector<bool>& doubtful, double wall_mm) {
    constexpr double kWalls = 3;
    const Section outline = section_of(contour, sections[own].plane);
    const Beyond before = look_beyond(outline, sections, own, doubtful, -1),
                 behind = look_beyond(outline, sections, own, doubtful, 1);
    if (before.evidence == PlaneEvidence::no_object || behind.evidence == PlaneEvidence::no_object)
        return PlaneEvidence::nothing;
    if (before.is_over_a_doubt && behind.is_over_a_doubt) return PlaneEvidence::nothing;
    const auto is_solid = [&](const Beyond& side) {
        return side.evidence == PlaneEvidence::object && side.depth_mm >= kWalls * wall_mm;
    };
    return is_solid(before) || is_solid(behind) ? PlaneEvidence::object : PlaneEvidence::nothing;
}

}  // namespace kontur
