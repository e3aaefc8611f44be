// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "kontur/drawing/boundary_point.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The true surface's outward normal near a point of it, mm.
using NormalAt = std::function<Vec3(const Vec3&)>;

/// Of a mask blurred by a Gaussian of so many voxels (the cube root of their volume): steps of voxels have no direction of
/// their own. Zero where the mask is the same all around. Keeps a reference to the mask.
NormalAt blurred_normal(const Mask& mask, double sigma_voxels);

/// By how much a mask is blurred for its normals, and for the question whether that matters.
inline constexpr double kBlurVoxels = 2, kMoreBlurVoxels = 3;

/// The default fit with the true tilt of the surface against the contour's plane at every point, instead of an estimate.
struct TrueTiltsFit {
    ImplicitFunction function;
    Mask mask;
};
TrueTiltsFit segment_with_true_tilts(const ContourSet& contours, const Grid& grid, const NormalAt& normal);

/// Mean angles at some hundreds of the points that take part in the fit, degrees.
struct NormalErrors {
    double all = 0;       ///< between the normals of the function and of the blurred truth
    double in_plane = 0;  ///< the same of their projections on the drawn plane, where the line itself tells the direction
    double truth = 0;     ///< between those of the truth blurred more and less
};
NormalErrors normal_errors(const ContourSet& contours, const Mask& truth, const ImplicitFunction& function);

}  // namespace kontur
