// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/geometry/shared_planes.h"

#include <algorithm>
#include <optional>

#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

bool lies_on(const Contour& contour, const Plane& plane, double tolerance) {
    return std::all_of(contour.points.begin(), contour.points.end(),
                       [&](const Vec3& p) { return std::abs(plane.distance_to(p)) <= tolerance; });
}

/// Rounding must not tilt an axial plane, nor the drawing direction turn it over.
Vec3 canonical(Vec3 normal) {
    constexpr double kRounding = 1e-9;
    int largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(normal[axis]) < kRounding) normal[axis] = 0;
        if (std::abs(normal[axis]) > std::abs(normal[largest])) largest = axis;
    }
    return normal[largest] < 0 ? -normal : normal;
}

Vec3 mean_point(const Contour& contour) {
    Vec3 sum;
    for (const Vec3& p : contour.points) sum += p;
    return sum / static_cast<double>(contour.points.size());
}

/// Planes found so far; `normals` are their different directions.
struct Planes {
    std::vector<Plane> planes;
    std::vector<Vec3> normals;
};

Plane plane_for(const Contour& contour, Planes& known, double tolerance) {
    for (const Plane& plane : known.planes)
        if (lies_on(contour, plane, tolerance)) return plane;
    for (const Vec3& normal : known.normals) {
        const Plane parallel = make_plane(mean_point(contour), normal);
        if (lies_on(contour, parallel, tolerance)) return known.planes.emplace_back(parallel);
    }
    const std::optional<Plane> fitted = fit_plane(contour.points);
    const Vec3 normal = canonical(fitted ? fitted->normal : Vec3{0, 0, 1});
    known.normals.push_back(normal);
    return known.planes.emplace_back(make_plane(mean_point(contour), normal));
}

}  // namespace

void assign_planes(std::vector<Contour>& contours, double tolerance_mm) {
    Planes known;
    for (const std::size_t n : largest_first(contours)) contours[n].plane = plane_for(contours[n], known, tolerance_mm);
}

}  // namespace kontur
