// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kontur/labels/label_boxes.h"
#include "kontur/labels/painted_object.h"

namespace kontur {

/// The largest distance in mm of neighbouring slices; 0 for single ones.
double largest_gap_mm(const PaintedObject& object);

/// Where an object may be filled, in indices of the image; beyond the first and the last of parallel slices as far as
/// `gaps_beyond` times the gap there, or as it may be wide where that is infinite.
IndexBox range_to_fill(const PaintedObject& object, const Grid& image, double gaps_beyond);

/// Whether a voxel of the range is unknown.
bool is_anything_left_out(const PaintedObject& object, const IndexBox& range);

/// What is said of an object of which nothing is.
std::string why_as_it_was(const PaintedObject& object);

}  // namespace kontur
