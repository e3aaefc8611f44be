// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/volume.h"

namespace kontur::app {

/// The label that lies at each voxel's centre of another grid: that of the nearest voxel, 0 beyond half a voxel outside.
Image labels_on_grid(const Image& labels, const Grid& grid);

/// The same with slices of the labels as slices of a finer grid: of all that lie nearest to one slice the nearest has its
/// labels, the others none. They lie across the axis along which the grid is the finest against the labels. Throws
/// Error(invalid_input) where the slices of both are not parallel.
Image slices_on_grid(const Image& labels, const Grid& grid);

}  // namespace kontur::app
