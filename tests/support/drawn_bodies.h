// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kontur/evidence.h"
#include "kontur/phantom/bodies.h"
#include "kontur/phantom/drawing.h"
#include "kontur/segment.h"
#include "kontur/sureness/surface_evidence.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "support/solids.h"

namespace kontur::test {

inline constexpr std::size_t kPointsPerPlane = 120;

inline ContourSet drawn(const Body& body, const std::vector<Plane>& planes) {
    return draw_sections(body, planes, kPointsPerPlane * planes.size());
}

/// Cubes of which about 40 go along the body, with a margin for what a fit makes of few contours.
inline Grid grid_for(const Body& body) {
    const Vec3 size = body.bounds().size();
    const double spacing = std::max({size.x, size.y, size.z}) / 40;
    return grid_around(body.bounds(), {spacing, spacing, spacing}, 8 * spacing);
}

struct Fitted : Segmentation {
    SurfaceEvidence evidence;
};

inline Fitted fitted(const ContourSet& contours, const Grid& grid, int threads = 1) {
    Fitted made{segment(contours, grid, {}, {.threads = threads}), {}};
    made.evidence = gather_evidence(made, contours, {.threads = threads});
    return made;
}

inline Fitted fitted(const Body& body, const std::vector<Plane>& planes) {
    return fitted(drawn(body, planes), grid_for(body));
}

/// Across the three axes through a point, in this order: z, y, x.
inline std::vector<Plane> three_planes(const Vec3& through) {
    return {make_plane(through, {0, 0, 1}), make_plane(through, {0, 1, 0}), make_plane(through, {1, 0, 0})};
}

inline std::vector<Plane> parallel_planes(const Body& body, std::size_t count) {
    std::vector<Plane> planes;
    for (std::size_t n = 0; n < count; ++n) {
        Vec3 at = body.bounds().center();
        at.z = body.bounds().min.z + (static_cast<double>(n) + 0.5) / static_cast<double>(count) * body.bounds().size().z;
        planes.push_back(make_plane(at, {0, 0, 1}));
    }
    return planes;
}

/// First-order signed distance in mm of a point from the body's surface, positive inside.
inline double depth_mm(const Body& body, const Vec3& p) { return body.value(p) / std::max(norm(body.gradient(p)), 0.1); }

/// Some of the places where the grid's edges cross the body's surface.
inline std::vector<Vec3> places_on(const Body& body, const Grid& grid) {
    std::vector<Vec3> places;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    Index3 next{i, j, k};
                    if (++next[axis] == grid.size[axis]) continue;
                    const Vec3 a = grid.center_mm(i, j, k), b = grid.center_mm(next.i, next.j, next.k);
                    const double from = body.value(a), to = body.value(b);
                    if ((from > 0) != (to > 0)) places.push_back(a + from / (from - to) * (b - a));
                }
    constexpr std::size_t kMost = 500;
    const std::size_t step = places.size() / kMost + 1;
    std::vector<Vec3> some;
    for (std::size_t n = step / 2; n < places.size(); n += step) some.push_back(places[n]);
    return some;
}

/// The share of the true surface that the band of the fitted one holds. A place's way to the fitted surface is taken along
/// the gradient of f, which is the shortest or longer, so that the share is not too large.
inline double held_of_true_surface(const Fitted& made, const Body& body, const Grid& grid) {
    const std::vector<Vec3> places = places_on(body, grid);
    std::vector<Vec3> found = places;
    for (Vec3& p : found)
        for (int step = 0; step < 8; ++step) {
            const Vec3 gradient = made.function.gradient(p);
            p = p - made.function.value(p) / std::max(dot(gradient, gradient), 0.05) * gradient;
        }
    const std::vector<double> widths = half_widths_mm(made.evidence, found);
    double held = 0;
    for (std::size_t n = 0; n < places.size(); ++n) held += distance(places[n], found[n]) <= widths[n];
    return held / static_cast<double>(places.size());
}

}  // namespace kontur::test
