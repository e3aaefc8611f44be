// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/change_lattice.h"
#include "kontur/correct/corrected_voxels.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// A mask's surface as triangles, and who made its points.
struct CorrectedMesh {
    TriangleMesh mesh;
    std::vector<CorrectedVoxel> made_by;  ///< of each point: what became of the voxels beside it; inside where nothing did
};

/// Makes meshes of a mask and of what corrections make of it. What the mask alone decides is found once, so that a mesh
/// costs its own points and what changes.
class ExistingMesh {
public:
    /// Linear in the surface's window. The surface has to live as long.
    explicit ExistingMesh(const ExistingSurface& surface, const Work& work = {});

    /// Where f0 + g vanishes, between voxels: closed, oriented outward, manifold. Points lie on the lines between
    /// neighbouring voxel centres, so that each centre is on the side that the mask with `voxels` changed says, also where g
    /// says otherwise; where the object reaches the grid's border, it ends half a voxel beyond. Normals are the downhill
    /// gradient. `change`: g, or null where it is 0. `voxels`: by offset.
    CorrectedMesh corrected(const ChangeLattice* change, std::span<const MadeVoxel> voxels, const Work& work = {}) const;
    TriangleMesh mesh(const Work& work = {}) const { return corrected(nullptr, {}, work).mesh; }

private:
    friend class CorrectedMeshBuilder;

    /// A cell with corners on both sides.
    struct Cell {
        std::int32_t i;
        std::uint8_t inside;  ///< a bit for each corner, as cell_triangles has them
    };

    void find_cells();

    const ExistingSurface& surface_;
    std::vector<float> values_;           ///< unshrunk_values
    std::vector<Cell> cells_;             ///< of the window
    std::vector<std::size_t> row_start_;  ///< of row j + size.j * k in these, and one end more
};

}  // namespace kontur
