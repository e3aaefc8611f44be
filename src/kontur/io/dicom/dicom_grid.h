// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: the voxel grid of a stack of slices, or why there is none.

#include <string>
#include <vector>

#include "kontur/io/dicom/dicom_stack.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// Where a slice of the grid lies among those of the stack.
struct SliceBetween {
    std::size_t slice = 0;  ///< of the stack, the one before it or itself
    double to_next = 0;     ///< share of the way to the next one, below 1
};

struct StackGrid {
    Grid grid;
    std::vector<std::string> notes;
    std::vector<SliceBetween> resampled{};  ///< one for each slice of the grid; empty: they are those of the stack
};

/// The grid whose voxel (i, j, k) is column i, row j of slice k. A gantry tilt becomes a sheared third axis, exactly, and a
/// note. Throws Error(unsupported), saying where, for missing slices, for slices off the regular spacing by more than 1 %
/// of it (or 0.01 mm) along the normal or 1 % (or 0.1 mm) across it, for several slices at one position and for a single
/// slice without a thickness. With `resample` missing slices and slices off the regular spacing are no fault.
StackGrid stack_grid(const DicomStack& stack, bool resample = false);

}  // namespace kontur
