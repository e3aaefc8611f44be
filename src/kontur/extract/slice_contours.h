// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The surface where it passes through the slices (planes of constant k) of its mask's grid, slice by slice: closed contours
/// around the mask's voxel centres on each slice, with points on the grid lines along i and j, at the function's zeros.
/// So the contours enclose exactly the mask's voxel centres, by the even-odd rule. `hole` is set on contours around an
/// outside region. An object cut off by the grid ends half a voxel beyond its outermost
/// voxel centres there, as its mesh does. `mask` is the function's, as
/// `segment` gives both. Throws Error(invalid_input) for a mask whose size contradicts its grid.
ContourSet slice_contours(const Mask& mask, const ImplicitFunction& function, const Work& work = {});

}  // namespace kontur
