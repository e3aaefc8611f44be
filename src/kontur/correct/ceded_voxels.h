// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A voxel that a correction took from a structure.
struct CededVoxel {
    std::size_t offset;
    std::size_t neighbor;  ///< offset of the nearest voxel in which the structure was not; of several one of them

    friend bool operator==(const CededVoxel&, const CededVoxel&) = default;
};

/// Of the voxels that left `before`, by offset; none where it fills its whole grid. Whose border the structure shared there
/// is what lies at their neighbours. The cost is that of a box around them, a little larger than it is deep.
std::vector<CededVoxel> ceded_voxels(const Mask& before, std::span<const std::size_t> left, const Work& work = {});
/// The same of all voxels of `before` that are not in `after`; both masks are of one grid.
std::vector<CededVoxel> ceded_voxels(const Mask& before, const Mask& after, const Work& work = {});

}  // namespace kontur
