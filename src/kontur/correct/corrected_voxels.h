// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/change.h"
#include "kontur/correct/change_lattice.h"
#include "kontur/correct/corrected_section.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/shape/index_box.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// What made a voxel what it is.
enum class CorrectedVoxel : std::uint8_t {
    outside = 0,          ///< as it was
    inside = 1,           ///< as it was
    added_drawn = 2,      ///< inside now, in a corrected plane
    removed_drawn = 3,    ///< outside now, in a corrected plane
    added_carried = 4,    ///< inside now, beside it
    removed_carried = 5,  ///< outside now, beside it
    added_image = 6,      ///< inside now, by the image
    removed_image = 7     ///< outside now, by the image
};

/// Where |g| is below this part of the smallest voxel side the old voxel stays.
inline constexpr double kLeastChangeVoxels = 0.04;

struct VoxelSide {
    std::size_t offset;
    bool inside;
};

/// A voxel that is not as it was.
struct MadeVoxel {
    std::size_t offset;
    CorrectedVoxel how;

    bool is_inside() const {
        return how == CorrectedVoxel::added_drawn || how == CorrectedVoxel::added_carried ||
               how == CorrectedVoxel::added_image;
    }
};

/// The voxels whose sides f0 + g changes, where g counts; by offset. `lattice`: of the change.
std::vector<VoxelSide> carried_voxels(const Mask& mask, const ExistingSurface& surface, const SurfaceChange& change,
                                      const ChangeLattice& lattice, const Work& work = {});

/// What was drawn in the planes that move and are slices of the grid; of whole slices in a box of voxels and where the drawn
/// outlines are.
std::vector<VoxelSide> drawn_voxels(const std::vector<CorrectedSection>& sections, const Grid& grid, const IndexBox& box);

/// What becomes of the mask's voxels: what was drawn counts more than what was carried on, and the image more than both.
/// By offset.
std::vector<MadeVoxel> made_voxels(const Mask& before, const std::vector<VoxelSide>& carried,
                                   const std::vector<VoxelSide>& drawn, const std::vector<VoxelSide>& by_image);

}  // namespace kontur
