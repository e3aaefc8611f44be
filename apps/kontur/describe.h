// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"

namespace kontur::app {

/// Size, spacing, origin, the patient axes that i, j, k run along (such as "LPS"), by how many degrees they are oblique to
/// them and sheared against each other, and whether they are left-handed.
Facts describe(const Grid& grid);

/// The grid, sample type, range of the finite values, how many are not finite where some are, and for a label map the voxels
/// and ml of each label.
Facts describe(const Image& image);

/// Planes, contours, points, holes, extent in mm, and the problems that would keep the set from being segmented.
Facts describe(const ContourSet& set);

/// What is said of a structure, as far as it is.
Facts describe(const StructureAttributes& attributes);

/// Points, triangles, closedness, orientation, Euler number, components and, of a closed and oriented one, the enclosed
/// volume and whether its faces look inwards.
Facts describe(const TriangleMesh& mesh);

}  // namespace kontur::app
