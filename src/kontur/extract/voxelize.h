// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/extract/voxelizer.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The voxels inside of the surface found. A voxel is inside where the function at its centre is > 0; a sheet or bubble that
/// no search met counts as absent. Every row starts outside and changes sides where the surface cuts it, so f is not
/// evaluated again (paper section 4.2). A lattice square has an even number of cut edges, and the search passes every face
/// with corners of both signs. So rows agree.
Mask fill(const SurfaceLattice& surface, const Work& work = {});

}  // namespace kontur
