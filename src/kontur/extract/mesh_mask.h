// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"

namespace kontur {

struct MeshMask {
    Mask mask;
    bool is_cut = false;  ///< the surface reaches beyond the grid's voxels
};

/// The voxels whose centres a closed surface encloses: a row of voxels is inside behind each odd crossing of the surface, so
/// the orientation of triangles does not count, and a surface within another is a hole. A centre on the surface belongs to
/// one side. Throws Error(invalid_input) for a surface so open that rows end inside, with their number; and as check_mesh
/// and check_grid do. Linear in triangles and in the rows that they cross.
MeshMask voxelize_mesh(const TriangleMesh& mesh, const Grid& grid, const Work& work = {});

}  // namespace kontur
