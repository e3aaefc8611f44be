// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"

namespace kontur::app {

/// `segment` for several ROIs of one structure set: each is fitted by itself; they become the labels 1, 2, ... of a label
/// map or the segments of a DICOM SEG, in the order in which they are named, and the ROIs of an RTSTRUCT. In a label map a
/// voxel of two keeps the first one's label, or of all ROIs the smaller one's, which is told with the number of such voxels;
/// a SEG or a .seg.nrrd keeps both. With `together` those that exclude each other share none (segment_together.h), and of
/// two of which one lies in the other the inner one gets the label.
void segment_rois(const SegmentCommand& command, Console& console);

/// Whether more than one ROI is asked for.
bool has_several(const SegmentCommand& command);

/// What can be refused by the words alone. Throws Error(invalid_input) for outputs that have room for one structure only.
void check_roi_words(const SegmentCommand& command);

}  // namespace kontur::app
