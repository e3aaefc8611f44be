// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kontur/shape/volume.h"

namespace kontur {

/// Inside voxels [begin, end) that follow each other along i, as offsets, and the face-connected component that they are in.
struct ComponentRun {
    std::size_t begin, end, component;
};

/// A mask's face-connected components, largest first; of equal ones the first in memory.
struct Components {
    std::vector<ComponentRun> runs;   ///< in memory order
    std::vector<std::int64_t> sizes;  ///< voxels of each component
};
/// Linear in the voxels; memory grows with the runs. Throws Error(invalid_input) when the mask does not hold one value per
/// voxel.
Components find_components(const Mask& mask);

/// Voxel counts of the mask's face-connected components, largest first; their number is the vector's size. Linear in the
/// voxels; memory grows with the runs of inside voxels along i. Throws Error(invalid_input) when the mask does not hold
/// one value per voxel.
std::vector<std::int64_t> component_sizes(const Mask& mask);

}  // namespace kontur
