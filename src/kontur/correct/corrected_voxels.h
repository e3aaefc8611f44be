// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/change.h"
#include "kontur/correct/corrected_section.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// What made a voxel what it is.
enum class CorrectedVoxel : std::uint8_t {
    outside = 0,         ///< as it was
    inside = 1,          ///< as it was
    added_drawn = 2,     ///< inside now, in a corrected plane
    removed_drawn = 3,   ///< outside now, in a corrected plane
    added_carried = 4,   ///< inside now, beside it
    removed_carried = 5, ///< outside now, beside it
    added_image = 6,     ///< inside now, by the image
    removed_image = 7    ///< outside now, by the image
};

/// Where |g| is below this part of the smallest voxel side the old voxel stays.
inline constexpr double kLeastChangeVoxels = 0.04;

struct VoxelSide {
    std::size_t offset;
    bool inside;
};

/// The mask with f0 + g > 0 inside, where g counts.
Mask changed_voxels(const Mask& mask, const ExistingSurface& surface, const SurfaceChange& change, const Work& work = {});

/// What was drawn in the planes that move and are slices of the grid.
std::vector<VoxelSide> drawn_voxels(const std::vector<CorrectedSection>& sections, const Grid& grid);

/// A CorrectedVoxel for every voxel of a mask that was corrected, where these were drawn and those are the image's.
std::vector<std::uint8_t> voxel_origins(const Mask& before, const Mask& after, const std::vector<VoxelSide>& drawn,
                                        const std::vector<VoxelSide>& by_image);

}  // namespace kontur
