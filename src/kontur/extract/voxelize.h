// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/extract/track.h"
#include "kontur/shape/volume.h"

namespace kontur {

enum class Voxelizer {
    tracked,     ///< follow the surface from the contours, then fill
    exhaustive,  ///< evaluate every voxel: the oracle; keeps sheets and bubbles that no contour touches
};
std::string_view name(Voxelizer voxelizer) noexcept;

/// The voxels inside of the surface: a voxel is inside when the function at its centre is > 0. Rows are filled from the
/// known values without further evaluation: between two known values the sign cannot change, because every lattice edge
/// that the surface cuts belongs to a cell whose values are known (paper section 4.2).
Mask fill(const SurfaceLattice& surface, int threads = 0);

}  // namespace kontur
