// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/drawn_regions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "kontur/base/parallel.h"
#include "kontur/drawing/each_of_many.h"

namespace kontur {
namespace {

std::vector<Vec3> places_of(const Section& section, const std::vector<Probe>& inside) {
    std::vector<Vec3> places;
    for (const Probe& probe : inside) places.push_back(section.plane.from_uv(probe.at));
    const auto share = static_cast<std::size_t>(each_of_many(section.outlines.size(), kLinePlaces));
    for (const Polygon2& outline : section.outlines)
        for_each_step(outline, share, [&](const Point2& p) { places.push_back(section.plane.from_uv(p)); });
    return places;
}

void append_crossings(const Section& other, DrawnRegion& region) {
    for (const Point2& at : crossings_with(region.section.plane, other))
        if (!region.search.contains(at)) region.crossings.push_back({at, region.search.clearance(at)});
}

}  // namespace

GroupedPlaces::GroupedPlaces(std::vector<Vec3> places) : places_(std::move(places)) { group(0, places_.size()); }

/// Halves them across their widest axis until few are left.
void GroupedPlaces::group(std::size_t begin, std::size_t end) {
    constexpr std::size_t kMost = 16;
    const auto at = [&](std::size_t i) { return places_.begin() + static_cast<std::ptrdiff_t>(i); };
    const Box3 box = bounding_box(std::span(at(begin), at(end)));
    if (end - begin <= kMost) {
        groups_.push_back({box.center(), kRoundedUp * box.diagonal() / 2, begin, end});
        return;
    }
    const Vec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(at(begin), at(middle), at(end), [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    group(begin, middle);
    group(middle, end);
}

std::vector<Point2> crossings_with(const Plane& plane, const Section& other) {
    std::vector<Point2> crossings;
    for (const Polygon2& outline : other.outlines)
        for_each_edge(outline, [&](const Point2& from, const Point2& to) {
            const Vec3 a = other.plane.from_uv(from), b = other.plane.from_uv(to);
            const double before = plane.distance_to(a), after = plane.distance_to(b);
            if ((before > 0) != (after > 0)) crossings.push_back(plane.to_uv(a + before / (before - after) * (b - a)));
        });
    return crossings;
}

std::vector<DrawnRegion> drawn_regions(const DrawnPlanes& planes, const Work& work) {
    std::vector<std::optional<DrawnRegion>> found(planes.sections.size());
    parallel_for(static_cast<std::int64_t>(found.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto s = static_cast<std::size_t>(begin); s < static_cast<std::size_t>(end); ++s) {
            const Section& section = planes.sections[s];
            std::vector<Probe> inside = probes(section);
            std::vector<Vec3> places = places_of(section, inside);
            const Ball3 ball = smallest_ball(places);
            const double radius_mm = std::sqrt(std::ranges::max(areas_without_holes(section)) / std::numbers::pi);
            found[s].emplace(DrawnRegion{
                section, SectionSearch(section), std::move(inside), GroupedPlaces(std::move(places)), ball, radius_mm, {}});
            for (const Section& other : planes.sections)
                if (&other != &section) append_crossings(other, *found[s]);
        }
    });
    std::vector<DrawnRegion> regions;
    for (std::optional<DrawnRegion>& one : found) regions.push_back(std::move(*one));
    return regions;
}

double faded(double noise_mm, double belief) { return noise_mm / (belief * belief); }

}  // namespace kontur
