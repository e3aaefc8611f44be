// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/derive/levels.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// The lines of level 0 on the slices of the image (constant k), as closed contours around the voxel centres inside. An
/// object that the image cuts off ends half a voxel beyond its outermost centres.
ContourSet level_contours(const Levels& levels, const WorkLattice& lattice, const Grid& image);

}  // namespace kontur
