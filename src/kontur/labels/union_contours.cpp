// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/union_contours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/extract/rasterize.h"
#include "kontur/labels/section_contours.h"
#include "kontur/labels/section_distances.h"

namespace kontur {
namespace {

constexpr double kNear = 0.02;  // mm; files round

bool is_same(const Plane& a, const Plane& b) {
    constexpr double kParallel = 1 - 1e-6;
    return std::abs(dot(a.normal, b.normal)) > kParallel && std::abs(a.distance_to(b.origin)) < kNear;
}

std::vector<Plane> planes_of(std::span<const ContourSet* const> structures) {
    std::vector<Plane> planes;
    for (const ContourSet* set : structures)
        for (const Contour& contour : set->contours)
            if (std::none_of(planes.begin(), planes.end(),
                             [&](const Plane& plane) { return is_same(plane, contour.plane); }))
                planes.push_back(contour.plane);
    return planes;
}

ContourSet closed_contours_in(const ContourSet& set, const Plane& plane) {
    ContourSet outlines;
    for (const Contour& contour : set.contours)
        if (contour.closed && is_same(plane, contour.plane)) outlines.contours.push_back(contour);
    return outlines;
}

bool lies_on_one_side(const ContourSet& set, const Plane& plane) {
    double low = 0, high = 0;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points)
            low = std::min(low, plane.distance_to(p)), high = std::max(high, plane.distance_to(p));
    return low > -kNear || high < kNear;
}

/// A grid with one slice, the plane, around contours in it.
Grid pixels_around(const std::vector<ContourSet>& sections, const Plane& plane, const UnionOptions& options) {
    double low_u = INFINITY, low_v = INFINITY, high_u = -INFINITY, high_v = -INFINITY;
    for (const ContourSet& section : sections)
        for (const Contour& contour : section.contours)
            for (const Vec3& p : contour.points) {
                const auto [u, v] = plane.to_uv(p);
                low_u = std::min(low_u, u), high_u = std::max(high_u, u);
                low_v = std::min(low_v, v), high_v = std::max(high_v, v);
            }
    const double margin = 4 * options.step_mm + options.close_mm;
    const double across = (high_u - low_u + 2 * margin) / options.step_mm,
                 down = (high_v - low_v + 2 * margin) / options.step_mm;
    if (constexpr double kMost = 1 << 28; !(across * down < kMost))
        throw Error(ErrorKind::too_large,
                    fmt::format("a plane of the union has {:.0f} pixels; the limit is {:.0f}", across * down, kMost));
    Grid grid{{static_cast<std::int64_t>(across) + 1, static_cast<std::int64_t>(down) + 1, 1}, {}};
    grid.index_to_mm.set_column(0, options.step_mm * plane.u);
    grid.index_to_mm.set_column(1, options.step_mm * plane.v);
    grid.index_to_mm.set_column(2, plane.normal);
    grid.index_to_mm.translation = plane.from_uv(low_u - margin, low_v - margin);
    return grid;
}

PaintedSlice united(const std::vector<ContourSet>& sections, const Grid& grid, double close_mm) {
    PaintedSlice all;
    all.section.assign(static_cast<std::size_t>(grid.voxel_count()), 0);
    std::vector<std::uint8_t> near(all.section.size());
    PaintedSlice grown = all;
    for (const ContourSet& section : sections) {
        PaintedSlice own;
        own.section = rasterize(section, grid).values;
        for (std::size_t n = 0; n < own.section.size(); ++n) all.section[n] |= own.section[n];
        if (!(close_mm > 0)) continue;
        const std::vector<double> distances = section_distances(grid, own);
        for (std::size_t n = 0; n < near.size(); ++n)
            if (distances[n] > -close_mm)
                near[n] = static_cast<std::uint8_t>(std::min(2, near[n] + 1)), grown.section[n] = 1;
    }
    if (!(close_mm > 0)) return all;
    // Shrunk again, so that nothing stands out where two structures meet at the rim.
    const std::vector<double> depths = section_distances(grid, grown);
    for (std::size_t n = 0; n < near.size(); ++n)
        all.section[n] |= near[n] > 1 && depths[n] > close_mm - grid.spacing_mm().x;
    return all;
}

/// Leaves out points that follow another too closely, but never more than leave four.
void space_out(Contour& contour, double spacing_mm) {
    constexpr std::size_t kLeast = 4;
    double length = 0;
    for (std::size_t n = 0; n < contour.points.size(); ++n)
        length += distance(contour.points[n], contour.points[(n + 1) % contour.points.size()]);
    const double least = std::min(spacing_mm, length / (2 * kLeast));
    std::vector<Vec3> corners;
    double since = least;
    for (std::size_t n = 0; n < contour.points.size(); ++n) {
        if (n > 0) since += distance(contour.points[n - 1], contour.points[n]);
        if (since < least) continue;
        corners.push_back(contour.points[n]), since = 0;
    }
    if (corners.size() >= kLeast) contour.points = std::move(corners);
}

}  // namespace

bool is_drawn_in(const ContourSet& set, const Plane& plane) {
    return std::any_of(set.contours.begin(), set.contours.end(),
                       [&](const Contour& contour) { return is_same(plane, contour.plane); });
}

double point_spacing_mm(std::span<const ContourSet* const> structures) {
    std::vector<double> lengths;
    for (const ContourSet* set : structures)
        for (const Contour& contour : set->contours)
            for (std::size_t n = 1; n < contour.points.size(); ++n)
                lengths.push_back(distance(contour.points[n - 1], contour.points[n]));
    if (lengths.empty()) return 0;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return *middle;
}

ContourSet union_contours(std::span<const ContourSet* const> structures, const UnionOptions& options) {
    ContourSet all;
    for (const Plane& plane : planes_of(structures)) {
        std::vector<ContourSet> sections;
        bool shows_all = true;
        for (const ContourSet* set : structures) {
            ContourSet section = closed_contours_in(*set, plane);
            if (!section.contours.empty()) sections.push_back(std::move(section));
            else shows_all = shows_all && lies_on_one_side(*set, plane);
        }
        if (!shows_all || sections.empty()) continue;
        const Grid grid = pixels_around(sections, plane, options);
        std::vector<Contour> contours = section_contours(grid, united(sections, grid, options.close_mm));
        for (Contour& contour : contours) space_out(contour, options.spacing_mm);
        std::move(contours.begin(), contours.end(), std::back_inserter(all.contours));
    }
    return all;
}

}  // namespace kontur
