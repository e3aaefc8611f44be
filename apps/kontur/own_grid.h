// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "kontur/base/geometry.h"
#include "kontur/shape/grid.h"

namespace kontur::app {

/// The mask's grid where no image gives one: voxels of --spacing-mm around a box in mm. Throws Error(too_large) for more
/// voxels than an image may have.
Grid own_grid(const SegmentCommand& command, const Box3& contours);

/// Says of an object that such a grid cuts off which option makes room; the library knows none.
void name_margin(const SegmentCommand& command, std::vector<std::string>& warnings);

}  // namespace kontur::app
