// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/derive/levels.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A mask on the lattice of its own image. Its steps are smoothed over about 0.7 voxels, and no voxel changes its side: the
/// surface lies between the centres of voxels inside and outside, half way where smoothing would move one. Between slices
/// that lie far apart the signed distances within the slices are interpolated (Raya and Udupa 1990); an end lies half a
/// slice beyond the last one.
Levels mask_levels(const Mask& mask, const WorkLattice& lattice, const Work& work);

}  // namespace kontur
