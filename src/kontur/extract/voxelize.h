// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/extract/voxelizer.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The voxels inside of the surface found: those at whose centre the function is > 0, except that a sheet or bubble that no
/// search met counts as absent. Every row starts outside and changes sides where the surface cuts it, so f is not evaluated
/// again (paper section 4.2). That is consistent: a lattice square has an even number of cut edges, and if one of them
/// belongs to the surface found then all do, because the search passes through every face with corners of both signs.
Mask fill(const SurfaceLattice& surface, const Work& work = {});

}  // namespace kontur
