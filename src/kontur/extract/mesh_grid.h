// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/extract/track.h"

namespace kontur {

/// The widest voxels of a mesh, as a fraction of the contours' diameter: chords across them leave out 0.1 % of a ball.
inline constexpr double kMeshSpacingFraction = 0.03;

/// The grid for a mesh of an object found as `surface` on the voxels of a mask: these voxels, each split along each axis
/// into an odd number of parts (1, 3, 5, ...), until none is wider than `spacing_mm` (> 0). So the mesh keeps to the
/// mask's voxel centres, which are among the finer grid's, and ends on the same outer faces where the image cuts the object
/// off. Only the part of the image around the object and the `starts` (mm) is covered. The surface's own grid when no voxel
/// is wide enough to be split.
Grid mesh_grid(const SurfaceLattice& surface, std::span<const Vec3> starts, double spacing_mm);

/// The whole grid with its voxels split so.
Grid with_split_voxels(const Grid& grid, double spacing_mm);

}  // namespace kontur
