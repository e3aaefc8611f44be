// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/index_box.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The voxels of a box within a mask's grid, as a mask of their own.
Mask part_of(const Mask& mask, const IndexBox& box);

}  // namespace kontur
