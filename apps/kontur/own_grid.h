// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"
#include "kontur/base/geometry.h"
#include "kontur/shape/grid.h"

namespace kontur::app {

/// The mask's grid where no image gives one: voxels of --spacing-mm around a box in mm. Throws Error(too_large) for more
/// voxels than an image may have.
Grid own_grid(const SegmentCommand& command, const Box3& contours);

}  // namespace kontur::app
