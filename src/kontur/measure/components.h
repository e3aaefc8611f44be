// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/shape/volume.h"

namespace kontur {

/// Voxel counts of the mask's face-connected components, largest first; their number is the vector's size. Linear in the
/// voxels; memory grows with the runs of inside voxels along i. Throws Error(invalid_input) when the mask does not hold
/// one value per voxel.
std::vector<std::int64_t> component_sizes(const Mask& mask);

}  // namespace kontur
