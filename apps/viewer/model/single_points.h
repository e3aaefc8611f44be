// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/contour.h"

namespace kontur::viewer {

/// Throws Error(too_large) for more points beside the contours than a project keeps of one structure.
void check_single_points(const ContourSet& set);

}  // namespace kontur::viewer
