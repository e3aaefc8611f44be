// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kontur/correct/corrected_voxels.h"
#include "kontur/correct_mask.h"
#include "kontur/shape/mesh.h"
#include "viewer/model/model.h"

namespace kontur::viewer {

/// What is said of a structure's mask: its contours, points and planes.
Corrections corrections_of(ContourSet drawing, const StructureMask& how);
bool says_nothing(const Corrections& corrections);
CorrectOptions correct_options(const StructureMask& how);

/// Who made a place of a corrected mask's surface.
enum class SurfaceOrigin : std::uint8_t { as_it_was = 0, drawn = 1, carried = 2, by_image = 3 };

/// Of each point of a mesh who made it, by what became of the voxels beside it.
std::vector<std::uint8_t> origins_of(const std::vector<CorrectedVoxel>& made_by);

/// A mask's surface, as smooth as the mask allows; no triangles for an empty mask.
TriangleMesh mesh_of(const Mask& mask, const Work& work = {});

/// The mask at the voxels of another grid: the same voxels where they lie on those of this one, else what its surface
/// encloses of them.
Mask on_grid(const Mask& mask, const Grid& grid, const Work& work = {});

}  // namespace kontur::viewer
