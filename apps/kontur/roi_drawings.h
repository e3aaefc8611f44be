// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "kontur/base/work.h"
#include "kontur/io/rtstruct.h"
#include "kontur/segment_together.h"

namespace kontur::app {

/// What is read once for all ROIs.
struct RoiDrawings {
    std::vector<Roi> rois;  ///< as named
    Grid grid;
    std::optional<Image> image;  ///< only where its voxels matter
    std::vector<std::string> notes;
};

/// The ROIs and the image that a command names. Throws as the readers do, and Error(invalid_input) for a ROI that has no
/// contour or is named twice.
RoiDrawings read_roi_drawings(const SegmentCommand& command, const Work& work);

/// What a command says about pairs of ROIs, by their positions. Throws Error(invalid_input) for words that do not name two
/// of them.
std::vector<StructurePair> roi_rules(const SegmentCommand& command, const std::vector<Roi>& rois);

}  // namespace kontur::app
