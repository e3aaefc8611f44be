// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "fuzz/choices.h"
#include "kontur/segment.h"

namespace kontur::fuzz {
namespace {

Vec3 direction(Choices& choose) {
    switch (choose.below(4)) {
        case 0:
            return {0, 0, 1};
        case 1:
            return {0, 1, 0};
        case 2:
            return {1, 0, 0};
        default:
            break;
    }
    const Vec3 v{choose.between(-1, 1), choose.between(-1, 1), choose.between(-1, 1)};
    return norm(v) > 1e-3 ? normalized(v) : Vec3{0, 0, 1};
}

/// Round, angular, wild or degenerate; now and then with repeated points.
std::vector<Vec3> outline(Choices& choose, const Plane& plane) {
    const int count = choose.below(24), kind = choose.below(5);
    const double radius = choose.between(0, 12), flatness = choose.between(0, 1);
    const double cx = choose.between(-6, 6), cy = choose.between(-6, 6);
    std::vector<Vec3> points;
    for (int n = 0; n < count; ++n) {
        const double angle = 2 * std::numbers::pi * n / count;
        double x = cx + radius * std::cos(angle), y = cy + radius * flatness * std::sin(angle);
        if (kind == 1) x = choose.between(-12, 12), y = choose.between(-12, 12);  // crosses itself
        if (kind == 2) x += choose.between(-1, 1), y += choose.between(-1, 1);
        if (kind == 3) y = cy + 1e-3 * flatness * y;  // nearly a line
        points.push_back(plane.origin + x * plane.u + y * plane.v);
        if (kind == 4 && n % 5 == 0) points.push_back(points.back());
    }
    return points;
}

Contour contour(Choices& choose) {
    const Vec3 normal = direction(choose);
    Contour contour;
    contour.plane = make_plane(choose.between(-10, 10) * normal, normal);
    contour.points = outline(choose, contour.plane);
    const int kind = choose.below(12);
    contour.closed = kind < 9;
    contour.hole = kind == 8;
    if (kind == 7) contour.end = choose.flag() ? ContourEnd::flat : ContourEnd::round;
    if (kind == 9) contour.inside = choose.flag() ? Hand::left : Hand::right;
    return contour;
}

std::vector<Vec3> clicks(Choices& choose) {
    std::vector<Vec3> points;
    for (int n = choose.below(16) - 12; n > 0; --n)
        points.push_back({choose.between(-15, 15), choose.between(-15, 15), choose.between(-15, 15)});
    return points;
}

/// From micrometres to kilometres, and far from the origin.
void place(Choices& choose, ContourSet& set) {
    const double scale = choose.flag() ? 1 : std::pow(10.0, choose.between(-4, 6));
    const Vec3 shift = choose.flag() ? Vec3{} : std::pow(10.0, choose.between(-2, 9)) * direction(choose);
    const auto moved = [&](const Vec3& p) { return scale * p + shift; };
    for (Contour& c : set.contours) {
        c.plane.origin = moved(c.plane.origin);
        for (Vec3& p : c.points) p = moved(p);
    }
    for (Vec3& p : set.interior) p = moved(p);
    for (Vec3& p : set.exterior) p = moved(p);
    for (SurfacePoint& p : set.surface) p.position = moved(p.position);
}

ContourSet drawing(Choices& choose) {
    ContourSet set;
    for (int n = 1 + choose.below(6); n > 0; --n) set.contours.push_back(contour(choose));
    set.interior = clicks(choose);
    set.exterior = clicks(choose);
    for (const Vec3& p : clicks(choose)) {
        SurfacePoint point{p};
        if (choose.flag()) point.outward = direction(choose);
        set.surface.push_back(point);
    }
    place(choose, set);
    return set;
}

SegmentOptions options(Choices& choose) {
    SegmentOptions options;
    options.threads = 1;
    options.mesh = choose.flag();
    options.normals = choose.below(4) == 0 ? Normals::in_plane : Normals::surface;
    options.fill_rule = choose.below(4) == 0 ? FillRule::declared : FillRule::even_odd;
    options.quality = choose.below(4) == 0 ? 1 : choose.between(0.01, 0.3);  // few points: more drawings in a second
    options.voxelizer = static_cast<Voxelizer>(choose.below(3));
    options.solver = choose.below(3) == 0 ? Solver::iterative : Solver::automatic;
    options.conflicts = static_cast<Conflicts>(choose.below(3));
    if (choose.below(4) == 0) options.smoothing = choose.between(0, 1e-2);
    if (choose.below(8) == 0) options.normal_offset_mm = choose.between(0, 3);
    return options;
}

Grid grid(Choices& choose, const ContourSet& set) {
    const Box3 box = bounding_box(set);
    const double spacing = std::max(box.diagonal(), 1e-9) / (6 + choose.below(14));
    Grid grid = grid_around(box, {spacing, spacing, spacing * (1 + choose.below(3))}, 2 * spacing);
    if (choose.below(4) == 0)  // left-handed and sheared
        grid.index_to_mm.set_column(0, -1 * grid.index_to_mm.column(0) + 0.3 * grid.index_to_mm.column(1));
    return grid;
}

}  // namespace

void pipeline(Bytes bytes) {
    Choices choose(bytes);
    const SegmentOptions chosen = options(choose);
    const ContourSet set = drawing(choose);
    check_contours(set);
    const Segmentation result = segment(set, grid(choose, set), chosen);
    const bool whole = static_cast<std::int64_t>(result.mask.values.size()) == result.mask.grid.voxel_count();
    if (!whole || !std::isfinite(result.report.residual.max_mm)) {
        std::fprintf(stderr, "broken promise: a whole mask and a finite residual\n");
        std::abort();
    }
}

}  // namespace kontur::fuzz
