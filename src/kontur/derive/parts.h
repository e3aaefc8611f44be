// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/derive/levels.h"

namespace kontur {

/// Cavities, which no way leads out of through the faces of voxels, become a part of the object.
Levels filled(Levels levels);

/// The largest part, of those that hang together by faces.
Levels largest_part(Levels levels);

/// The parts of at least so many ml.
Levels parts_from(Levels levels, const Grid& grid, double least_ml);

}  // namespace kontur
