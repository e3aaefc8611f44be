// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

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

/// A mask's surface, as smooth as the mask allows; no triangles for an empty mask. Of each point who made it: what changed
/// of the voxels around it, the drawn ones first.
TriangleMesh mesh_of(const Mask& mask, const Work& work = {});
std::vector<std::uint8_t> origins_of(const TriangleMesh& mesh, const CorrectedMask& corrected);

/// The mask at the voxels of another grid: the same voxels where they lie on those of this one, else what its surface
/// encloses of them.
Mask on_grid(const Mask& mask, const Grid& grid, const Work& work = {});

}  // namespace kontur::viewer
