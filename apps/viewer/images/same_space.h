// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/shape/grid.h"
#include "viewer/images/opened_image.h"

namespace kontur::viewer {

/// What has to be assumed, or doubted, when the second image is laid on the first, one sentence each: that both lie in one
/// patient space where not both name a frame of reference, and another patient's number. Throws Error(invalid_input) where
/// they name different frames of reference, and where their boxes do not meet.
std::vector<std::string> assumptions_of_one_space(const OpenedImage& first, const OpenedImage& second);

/// By how much the grids' boxes, to the outermost faces of their voxels, are apart at least; 0 or less where they meet.
/// Exact in this for oblique and sheared grids, too.
double gap_mm(const Grid& a, const Grid& b);

}  // namespace kontur::viewer
