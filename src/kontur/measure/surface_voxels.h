// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/shape/volume.h"

namespace kontur {

/// Throws Error(invalid_input), saying how they differ, when two masks are no masks of one grid: their sizes are not the
/// same, or corners lie more than 0.001 mm apart.
void check_comparable(const Mask& a, const Mask& b);

/// The centres, mm, of the inside voxels that have an outside face neighbour; beyond the grid all is outside.
std::vector<Vec3> surface_voxels(const Grid& grid, const std::vector<std::uint8_t>& inside);

}  // namespace kontur
