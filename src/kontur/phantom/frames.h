// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/grid.h"

/// The grids of the phantom, all in one frame (mm, LPS).
namespace kontur {

/// 10,711,151 voxels of 0.62 x 0.62 x 1.8 mm around the liver.
Grid liver_grid();

/// 1,058,508 voxels of 0.56 mm around the metastasis, inside the liver's grid.
Grid metastasis_grid();

/// The grid turned about its centre by 20, 10 and 5 degrees around x, y and z: a scan with oblique slices.
Grid oblique(const Grid& grid);

}  // namespace kontur
