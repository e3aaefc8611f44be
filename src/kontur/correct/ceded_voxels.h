// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A voxel that a correction took from a structure.
struct CededVoxel {
    std::size_t offset;
    std::size_t neighbor;  ///< offset of the nearest voxel in which the structure was not; of several one of them
};

/// The voxels of `before` that are not in `after`, in memory order; none where `before` fills its whole grid. Whose border
/// the structure shared there is what lies at their neighbours. Both masks are of one grid. Linear in the structure's box.
std::vector<CededVoxel> ceded_voxels(const Mask& before, const Mask& after, const Work& work = {});

}  // namespace kontur
