// SPDX-License-Identifier: Apache-2.0
#include "fuzz/drawings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
    for (Plane& plane : set.empty_planes) plane.origin = moved(plane.origin);
}

}  // namespace

ContourSet wild_drawing(Choices& choose) {
    ContourSet set;
    for (int n = 1 + choose.below(6); n > 0; --n) set.contours.push_back(contour(choose));
    set.interior = clicks(choose);
    set.exterior = clicks(choose);
    for (const Vec3& p : clicks(choose)) {
        SurfacePoint point{p};
        if (choose.flag()) point.outward = direction(choose);
        set.surface.push_back(point);
    }
    for (const Vec3& p : clicks(choose)) set.empty_planes.push_back(make_plane(p, direction(choose)));
    place(choose, set);
    return set;
}

namespace {

/// An ellipsoid about the origin, cut by planes.
struct Ellipsoid {
    Vec3 radii;

    /// `count` points of its section by the plane at `height` along an axis; none where there is no section.
    Contour section(int axis, double height, int count, double noise_mm, Choices& choose) const {
        Vec3 normal{}, origin{};
        normal[axis] = 1;
        origin[axis] = height;
        Contour contour;
        contour.plane = make_plane(origin, normal);
        const double share = std::sqrt(std::max(0.0, 1 - height * height / (radii[axis] * radii[axis])));
        for (int n = 0; n < count; ++n) {
            const double angle = 2 * std::numbers::pi * n / count;
            const double wobble = noise_mm > 0 ? choose.between(-noise_mm, noise_mm) : 0;
            Vec3 p = origin;
            p[(axis + 1) % 3] = (share * radii[(axis + 1) % 3] + wobble) * std::cos(angle);
            p[(axis + 2) % 3] = (share * radii[(axis + 2) % 3] + wobble) * std::sin(angle);
            contour.points.push_back(p);
        }
        return contour;
    }
};

/// A stretch of it, a hole in it, an end or a weight.
void vary(Choices& choose, Contour& contour) {
    switch (choose.below(8)) {
        case 1:
            contour.points.resize(std::max<std::size_t>(contour.points.size() * 3 / 4, 2));
            contour.closed = false;
            if (choose.flag()) contour.inside = Hand::left;
            break;
        case 2:
            contour.end = choose.flag() ? ContourEnd::flat : ContourEnd::round;
            break;
        case 3:
            contour.weight = std::pow(10.0, choose.between(-3, 3));
            break;
        case 4:
            for (Vec3& p : contour.points)
                p = contour.plane.origin + 0.4 * (p - contour.plane.origin);  // nested where the plane is drawn twice
            contour.hole = choose.flag();
            break;
        default:
            break;
    }
}

std::vector<Vec3> points_near(Choices& choose, const Vec3& radii, int most) {
    std::vector<Vec3> points;
    for (int n = choose.below(2 * most) - most; n > 0; --n) {
        const Vec3 d = normalized({choose.between(-1, 1), choose.between(-1, 1), choose.between(-1, 1)});
        const double share = choose.between(0.3, 1.7);
        points.push_back({share * radii.x * d.x, share * radii.y * d.y, share * radii.z * d.z});
    }
    return points;
}

}  // namespace

ContourSet mixed_drawing(Choices& choose) {
    const Ellipsoid body{{choose.between(10, 40), choose.between(10, 40), choose.between(10, 40)}};
    ContourSet set;
    for (int n = 1 + choose.below(12); n > 0; --n) {
        const int axis = choose.below(4) == 0 ? choose.below(3) : 2;
        const double height = 0.95 * body.radii[axis] * choose.between(-1, 1);
        Contour contour = body.section(axis, height, 5 + choose.below(60), choose.below(3) == 0 ? 1 : 0, choose);
        const bool twice = choose.below(8) == 0;
        if (twice) set.contours.push_back(contour);
        vary(choose, contour);
        set.contours.push_back(std::move(contour));
    }
    set.interior = points_near(choose, body.radii, 4);
    set.exterior = points_near(choose, body.radii, 4);
    for (const Vec3& p : points_near(choose, body.radii, 40)) {
        SurfacePoint point{p};
        if (choose.flag()) point.outward = normalized(p);
        set.surface.push_back(point);
    }
    for (const Vec3& p : points_near(choose, body.radii, 2)) set.empty_planes.push_back(make_plane(p, normalized(p)));
    return set;
}

}  // namespace kontur::fuzz
