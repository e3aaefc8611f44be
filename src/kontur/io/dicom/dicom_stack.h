// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: which image files form one volume.

#include <string>
#include <vector>

#include "kontur/io/dicom/dicom_header.h"

namespace kontur {

/// Parallel slices of one series, in the order of their position along the slice normal.
struct DicomStack {
    std::vector<DicomHeader> slices;
    std::string distinction;  ///< what sets it apart in its series, such as "echo 2"; "" when nothing had to
    std::vector<std::string> notes;
};

/// Groups by series, size, orientation, pixel spacing and frame of reference; where slices would then share positions, by
/// dose grid, temporal position, echo, echo time, b-value, frame type or acquisition, and at last, unless they are frames,
/// by their rank in trigger time and instance number at each position. File names and instance numbers never decide the
/// order of slices. Slices that nothing tells apart stay together, to be refused by `stack_grid`. Stacks come in the order
/// of their series UIDs.
std::vector<DicomStack> group_into_stacks(std::vector<DicomHeader> headers);

/// Distances in mm of the slices from the first along its normal.
std::vector<double> positions_along_normal(const std::vector<DicomHeader>& slices);

/// Slices nearer than this along the normal lie at one position.
inline constexpr double kSamePositionMm = 1e-3;

}  // namespace kontur
