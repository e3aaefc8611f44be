// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/extract/voxelize.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// The cells of a grid that the surface passes through: all of them (exhaustive), else those that are connected with one of
/// the starts, or with a place where the surface comes into the grid.
SurfaceLattice find_surface(const ImplicitFunction& function, const Grid& grid, std::vector<Vec3> starts,
                            Voxelizer voxelizer = Voxelizer::adaptive, const Work& work = {});

struct SurfaceMeshOptions {
    double spacing_mm;                          ///< > 0: chords are no longer
    Voxelizer voxelizer = Voxelizer::adaptive;  ///< with which the surface was found
};

/// The surface on the lattice that it was found on, or on a finer one where that is coarser than the spacing: chords between
/// slices that are far apart leave out a part of the object.
TriangleMesh surface_mesh(const SurfaceLattice& surface, const ImplicitFunction& function, std::vector<Vec3> starts,
                          const SurfaceMeshOptions& options, const Work& work = {});

}  // namespace kontur
