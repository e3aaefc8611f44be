// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/phantom/bodies.h"
#include "kontur/phantom/random.h"
#include "kontur/shape/contour.h"

/// How the phantom's contours are drawn. Internal to the phantom.
namespace kontur {

/// `count` points at equal distances of arc length along a closed polygon, the first half a distance from its first point.
std::vector<Vec3> resample_closed(std::span<const Vec3> points, std::size_t count);

/// Cuts the body by the planes into contours of `point_count` points altogether, equally spaced and on the body's surface
/// within 1e-9 mm. Sections smaller than 10 mm^2 are left out.
ContourSet draw_sections(const Body& body, std::span<const Plane> planes, std::size_t point_count);

/// The body's unit outward normals at each contour's points.
std::vector<std::vector<Vec3>> surface_normals(const Body& body, const ContourSet& set);

/// The imprecision of freehand drawing.
struct HandOptions {
    double rms_mm = 0.6;           ///< displacement along the contour's in-plane normal, in waves
    double shortest_wave_mm = 25;  ///< wavelengths along the contour lie between these two ...
    double longest_wave_mm = 120;
    double jitter_mm = 0.06;  ///< ... and independent of point to point, standard deviation along u and v
};
ContourSet drawn_by_hand(ContourSet contours, const Body& body, const HandOptions& options, Random& random);

}  // namespace kontur
