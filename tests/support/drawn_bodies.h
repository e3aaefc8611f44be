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

}  // namespace kontur::test
