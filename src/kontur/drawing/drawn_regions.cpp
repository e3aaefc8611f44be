// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/drawn_regions.h"

#include <algorithm>
#include <optional>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr std::size_t kLinePlaces = 24, kFewestLinePlaces = 4;  // per outline
constexpr std::size_t kAllLinePlaces = 2400;                    // about, of a section with many of them

std::vector<Vec3> places_of(const Section& section, const std::vector<Probe>& inside) {
    std::vector<Vec3> places;
    for (const Probe& probe : inside) places.push_back(section.plane.from_uv(probe.at));
    const std::size_t share = std::clamp(kAllLinePlaces / section.outlines.size(), kFewestLinePlaces, kLinePlaces);
    for (const Polygon2& outline : section.outlines) {
        const std::size_t stride = std::max<std::size_t>(1, outline.size() / share);
        for (std::size_t i = 0; i < outline.size(); i += stride) places.push_back(section.plane.from_uv(outline[i]));
    }
    return places;
}

void append_crossings(const Section& other, DrawnRegion& region) {
    const Plane& plane = region.section.plane;
    for (const Polygon2& outline : other.outlines)
        for_each_edge(outline, [&](const Point2& from, const Point2& to) {
            const Vec3 a = other.plane.from_uv(from), b = other.plane.from_uv(to);
            const double before = plane.distance_to(a), after = plane.distance_to(b);
            if ((before > 0) == (after > 0)) return;
            const Point2 at = plane.to_uv(a + before / (before - after) * (b - a));
            if (!region.search.contains(at)) region.crossings.push_back({at, region.search.clearance(at)});
        });
}

}  // namespace

std::vector<DrawnRegion> drawn_regions(const DrawnPlanes& planes, const Work& work) {
    std::vector<std::optional<DrawnRegion>> found(planes.sections.size());
    parallel_for(static_cast<std::int64_t>(found.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto s = static_cast<std::size_t>(begin); s < static_cast<std::size_t>(end); ++s) {
            const Section& section = planes.sections[s];
            std::vector<Probe> inside = probes(section);
            std::vector<Vec3> places = places_of(section, inside);
            const Ball3 ball = smallest_ball(places);
            found[s].emplace(DrawnRegion{section, SectionSearch(section), std::move(inside), std::move(places), ball, {}});
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
