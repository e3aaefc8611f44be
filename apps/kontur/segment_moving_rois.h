// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"
#include "roi_drawings.h"

namespace kontur::app {

/// `segment` for ROIs that were drawn in several frames of the images: each is segmented over time by itself. They become
/// the labels of a 4D label map, or the segments of a DICOM SEG with time as a dimension. What overlaps is as in one frame.
void segment_moving_rois(const SegmentCommand& command, const RoiDrawings& drawings, Console& console);

}  // namespace kontur::app
