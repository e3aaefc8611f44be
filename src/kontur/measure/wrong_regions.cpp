// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/wrong_regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace kontur {
namespace {

constexpr double kLeastSine = 0.05;  // of the angle between planes that have a line in common
constexpr double kParallel = 0.95;   // cosine: of planes of one stack
constexpr std::size_t kFewestPixels = 3;

/// The line that two planes share, along with the stretch of it that either one's outlines span.
struct CommonLine {
    Vec3 origin, direction;
    double low = std::numeric_limits<double>::infinity(), high = -low;

    void span(const PlaneLook& look) {
        if (!look.section()) return;
        const auto& [least, most] = look.box();
        for (const double u : {least[0], most[0]})
            for (const double v : {least[1], most[1]}) {
                const double at = dot(direction, look.plane().from_uv(u, v) - origin);
                low = std::min(low, at);
                high = std::max(high, at);
            }
    }
};

std::optional<CommonLine> common_line(const PlaneLook& a, const PlaneLook& b) {
    const Plane &first = a.plane(), &second = b.plane();
    const Vec3 direction = cross(first.normal, second.normal);
    const double sine = norm(direction);
    if (sine < kLeastSine) return std::nullopt;
    const double off = second.distance_to(first.origin), cosine = dot(first.normal, second.normal);
    const Vec3 across = (second.normal - cosine * first.normal) / (sine * sine);
    CommonLine line{first.origin - off * across, direction / sine};
    line.span(a);
    line.span(b);
    return line;
}

double step_mm(const PlaneLook& a, const PlaneLook& b) {
    if (!a.section()) return b.pixel_mm();
    return b.section() ? std::min(a.pixel_mm(), b.pixel_mm()) : a.pixel_mm();
}

/// Adds each stretch of the line on which the fills differ to both planes.
void add_stretches(const PlaneLook& a, const PlaneLook& b, std::vector<Contradiction>& of_a,
                   std::vector<Contradiction>& of_b) {
    constexpr std::size_t kPlaces = 6;
    if (!a.section() && !b.section()) return;
    const auto line = common_line(a, b);
    if (!line || !(line->high > line->low)) return;
    const double step = step_mm(a, b);
    std::vector<Vec3> stretch;
    const auto end = [&] {
        if (stretch.empty()) return;
        Contradiction one{{}, step * static_cast<double>(stretch.size())};
        const std::size_t stride = std::max<std::size_t>(1, stretch.size() / kPlaces);
        for (std::size_t n = 0; n < stretch.size(); n += stride) one.places.push_back(stretch[n]);
        stretch.clear();
        of_a.push_back(one);
        of_b.push_back(std::move(one));
    };
    const auto steps = static_cast<std::int64_t>((line->high - line->low) / step) + 4;
    for (std::int64_t n = 0; n <= steps; ++n) {
        const Vec3 place = line->origin + (line->low + (static_cast<double>(n) - 2) * step) * line->direction;
        if (a.contains(a.plane().to_uv(place)) != b.contains(b.plane().to_uv(place))) stretch.push_back(place);
        else end();
    }
    end();
}

/// A point of the set that is on the wrong side of what is drawn in a plane near it.
void add_point(const Vec3& point, bool may_be_inside, bool may_be_outside, const PlaneLook& look,
               std::vector<Contradiction>& all) {
    if (!look.section()) return;
    const Point2 at = look.plane().to_uv(point);
    const double clearance = look.clearance(at), off = std::abs(look.plane().distance_to(point));
    if (off >= clearance || (look.contains(at) ? may_be_inside : may_be_outside)) return;
    all.push_back({{look.plane().from_uv(at)}, 2 * clearance});
}

/// One wrong region, as its pixels are gone through.
struct Region {
    std::vector<std::size_t> pixels;
    std::size_t deepest = 0;
};

/// Which regions of the drawing the result misses wholly, and which of the result the drawing does not know.
struct Wholes {
    PixelParts drawn, result;
    std::vector<bool> is_lost, is_island;

    explicit Wholes(const Sheet& sheet) : drawn(connected_parts(sheet.lattice, sheet.filled)) {
        std::vector<std::uint8_t> inside(sheet.values.size());
        for (std::size_t pixel = 0; pixel < inside.size(); ++pixel) inside[pixel] = sheet.is_inside(pixel);
        result = connected_parts(sheet.lattice, inside);
        is_lost.assign(drawn.count + 1, true);
        is_island.assign(result.count + 1, true);
        for (std::size_t pixel = 0; pixel < inside.size(); ++pixel)
            if (drawn.part[pixel] != 0 && result.part[pixel] != 0)
                is_lost[drawn.part[pixel]] = is_island[result.part[pixel]] = false;
    }
};

std::vector<Region> regions_of(const Sheet& sheet, const std::vector<std::uint8_t>& marked) {
    const PixelParts parts = connected_parts(sheet.lattice, marked);
    std::vector<Region> regions(parts.count);
    for (std::size_t pixel = 0; pixel < marked.size(); ++pixel) {
        if (parts.part[pixel] == 0) continue;
        Region& region = regions[parts.part[pixel] - 1];
        if (region.pixels.empty() || sheet.depths[pixel] > sheet.depths[region.deepest]) region.deepest = pixel;
        region.pixels.push_back(pixel);
    }
    return regions;
}

double nearest_mm(const Region& region, const PlaneLook& look, const Sheet& sheet, const Contradiction& contradiction,
                  double limit_mm) {
    double least2 = std::numeric_limits<double>::infinity();
    for (const Vec3& place : contradiction.places) {
        const Point2 at = look.plane().to_uv(place);
        for (const std::size_t pixel : region.pixels) {
            const Point2 p = sheet.lattice.at(pixel);
            const double dx = p[0] - at[0], dy = p[1] - at[1];
            least2 = std::min(least2, dx * dx + dy * dy);
        }
        if (least2 <= limit_mm * limit_mm) break;
    }
    return std::sqrt(least2);
}

/// A region is the drawing's own where planes contradict each other on a stretch no farther away than it is long, and where
/// the region is not much larger than such stretches make it. Of by-hand drawings of organs twice that distance leaves half
/// of the faults unnamed, half of it doubles the sentences where nothing is wrong.
bool is_explained(const Region& region, const PlaneLook& look, const Sheet& sheet,
                  const std::vector<Contradiction>& contradictions) {
    constexpr double kNear = 1, kMuch = 4;
    double squares = 0;
    const double area = static_cast<double>(region.pixels.size()) * sheet.lattice.pixel_mm2();
    for (const Contradiction& one : contradictions) {
        const double reach = kNear * std::max(one.length_mm, sheet.lattice.step_mm);
        if (nearest_mm(region, look, sheet, one, reach) <= reach) squares += one.length_mm * one.length_mm;
        if (squares > 0 && area <= kMuch * squares) return true;
    }
    return false;
}

bool are_parallel(const PlaneLook& a, const PlaneLook& b) {
    return std::abs(dot(a.plane().normal, b.plane().normal)) > kParallel;
}

/// Whether two planes are slices of one stack: parallel, and part of what the one shows lies over what the other shows.
/// Rings of a helix a turn apart are parallel, too, and lie beside each other.
bool are_slices(const PlaneLook& a, const PlaneLook& b) {
    constexpr std::size_t kPlaces = 100;
    return are_parallel(a, b) && std::ranges::any_of(a.filled_places(kPlaces),
                                                     [&](const Vec3& place) { return b.contains(b.plane().to_uv(place)); });
}

}  // namespace

std::vector<std::vector<Contradiction>> contradictions(std::span<const PlaneLook> looks, const ContourSet& set) {
    std::vector<std::vector<Contradiction>> all(looks.size());
    for (std::size_t a = 0; a < looks.size(); ++a) {
        for (std::size_t b = a + 1; b < looks.size(); ++b) add_stretches(looks[a], looks[b], all[a], all[b]);
        for (const Vec3& p : set.interior) add_point(p, true, false, looks[a], all[a]);
        for (const Vec3& p : set.exterior) add_point(p, false, true, looks[a], all[a]);
        for (const SurfacePoint& p : set.surface) add_point(p.position, false, false, looks[a], all[a]);
    }
    return all;
}

OtherPlanes::OtherPlanes(std::span<const PlaneLook> looks, double tolerance_mm)
    : looks_(looks), tolerance_mm_(tolerance_mm) {
    // The drawn ones come first. What is given as empty does not make a stack less of one.
    for (const PlaneLook& look : looks)
        if (look.section()) are_parallel_ = are_parallel_ && are_parallel(look, looks.front());
}

bool OtherPlanes::silence(const PlaneLook& own, const Vec3& place) const {
    if (are_parallel_ || !own.section()) return false;
    const double clearance = own.clearance(own.plane().to_uv(place));
    if (clearance < own.extent_mm()) return false;
    const double near = clearance / 2;
    return std::any_of(looks_.begin(), looks_.end(), [&](const PlaneLook& other) {
        if (&other == &own || !other.section()) return false;
        const double off = std::abs(other.plane().distance_to(place));
        if (off >= near) return false;
        const Point2 at = other.plane().to_uv(place);
        return (other.contains(at) || std::hypot(off, other.clearance(at)) < near) && !are_slices(own, other);
    });
}

bool OtherPlanes::deny(const PlaneLook& own, const Vec3& place, bool filled) const {
    return std::any_of(looks_.begin(), looks_.end(), [&](const PlaneLook& other) {
        return &other != &own && std::abs(other.plane().distance_to(place)) < tolerance_mm_ &&
               norm(cross(own.plane().normal, other.plane().normal)) < kLeastSine &&
               other.contains(other.plane().to_uv(place)) != filled;
    });
}

std::vector<WrongRegion> wrong_regions(const PlaneLook& look, const std::vector<Contradiction>& contradictions,
                                       const OtherPlanes& others, double tolerance_mm) {
    std::vector<WrongRegion> result;
    for (const Sheet* sheet : {&look.near(), &look.far()}) {
        std::vector<std::uint8_t> missing(sheet->values.size()), surplus(sheet->values.size());
        bool any = false;
        for (std::size_t pixel = 0; pixel < missing.size(); ++pixel) {
            if (!(sheet->depths[pixel] > tolerance_mm)) continue;
            const bool filled = sheet->filled[pixel] != 0;
            if (others.deny(look, look.plane().from_uv(sheet->lattice.at(pixel)), filled)) continue;
            (filled ? missing : surplus)[pixel] = 1;
            any = true;
        }
        if (!any) continue;
        const Wholes wholes(*sheet);
        for (const auto* marked : {&missing, &surplus})
            for (const Region& region : regions_of(*sheet, *marked)) {
                if (region.pixels.size() < kFewestPixels && sheet == &look.near()) continue;
                const Vec3 place = look.plane().from_uv(sheet->lattice.at(region.deepest));
                const bool is_missing = marked == &missing;
                if (!is_missing && others.silence(look, place)) continue;
                result.push_back({place, static_cast<double>(region.pixels.size()) * sheet->lattice.pixel_mm2(),
                                  sheet->depths[region.deepest], is_missing,
                                  !is_missing && wholes.is_island[wholes.result.part[region.deepest]],
                                  is_missing && wholes.is_lost[wholes.drawn.part[region.deepest]],
                                  is_explained(region, look, *sheet, contradictions)});
            }
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const WrongRegion& a, const WrongRegion& b) { return a.area_mm2 > b.area_mm2; });
    return result;
}

}  // namespace kontur
