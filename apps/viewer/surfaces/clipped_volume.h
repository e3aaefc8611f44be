// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"

namespace kontur::viewer {

/// How much of a closed mesh lies within the image, out to the outer faces of its voxels, in mm^3: what masks and surface
/// files on this grid hold. Exact for the triangles; linear in their number. 0 without triangles.
double volume_within_mm3(const TriangleMesh& mesh, const Grid& image);

}  // namespace kontur::viewer
