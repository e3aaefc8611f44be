// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"

namespace kontur {

struct TraceOptions {
    /// Distance of the sampling lattice's nodes on a plane; 0: half the mask's smallest voxel spacing.
    double step_mm = 0;
    /// Points are dropped while no dropped point lies farther than this from the remaining polygon.
    double tolerance_mm = 1e-6;
    /// Smaller contours are dropped.
    double min_area_mm2 = 0;
};

/// Cuts a mask by planes of any orientation into closed contours, plane by plane in the given order. They are the 0.5 level
/// of the mask's trilinear interpolation. Outside of the grid the mask is 0, so an object that the grid cuts off ends half a
/// voxel beyond its outermost voxel centres. Points lie on their plane within rounding. Contours run counter-clockwise about
/// the plane's normal, holes clockwise. A plane that misses the object gives no contour. Throws Error(invalid_input), naming
/// the plane (counted from 1), when its axes are not orthonormal, and for options or a mask that make no sense.
ContourSet trace(const Mask& mask, std::span<const Plane> planes, const TraceOptions& options = {}, const Work& work = {});

}  // namespace kontur
