// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/correct/change.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// Where f0 of a mask vanishes, between the voxels of its window: closed, oriented outward, manifold. Points lie on the
/// lines between neighbouring voxel centres, so that each centre is on the side that the mask says; where the object reaches
/// the grid's border, it ends half a voxel beyond. Normals are f0's downhill gradient. Linear in the window's voxels.
TriangleMesh existing_mesh(const ExistingSurface& surface, const Work& work = {});

/// The same of a corrected mask, whose changed voxels all lie in the surface's window, at a fraction of the cost: where f0 +
/// g vanishes. `unshrunk`: unshrunk_values of the surface. Where g and the mask disagree the mask's voxels count.
TriangleMesh corrected_mesh(const ExistingSurface& surface, std::vector<float> unshrunk, const SurfaceChange& change,
                            const Mask& corrected, const Work& work = {});

}  // namespace kontur
