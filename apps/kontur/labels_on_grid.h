// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/volume.h"

namespace kontur::app {

/// The label that lies at each voxel's centre of another grid: that of the nearest voxel, 0 beyond half a voxel outside.
Image labels_on_grid(const Image& labels, const Grid& grid);

}  // namespace kontur::app
