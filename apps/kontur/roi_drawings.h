// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "kontur/base/work.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/segment_together.h"

namespace kontur::app {

/// One of all ROIs that cannot be segmented here.
struct LeftOutRoi {
    Roi roi;
    std::string reason;
};

/// What is read once for all ROIs.
struct RoiDrawings {
    std::vector<Roi> rois{};             ///< as named
    std::vector<LeftOutRoi> left_out{};  ///< of --all-rois
    Grid grid{};
    std::optional<Image> image{};  ///< only where its voxels matter
    std::vector<std::string> notes{};
    bool are_moving = false;  ///< drawn in several frames of the images; the contours have them
    ImageInput input{};       ///< that was read: of images in time the frame in which all was drawn, where none was chosen
};

/// The ROIs and the image that a command names. Of --all-rois those whose contours cannot be segmented or lie outside of the
/// image are left out, unless that are all. Throws as the readers do, for a damaged ROI, and Error(invalid_input) for a ROI
/// that has no contour or is named twice, and for ROIs of which some alone refer to frames of the images.
RoiDrawings read_roi_drawings(const SegmentCommand& command, const Work& work);

/// What a command says about pairs of ROIs, by their positions; nothing about those that are left out. Throws
/// Error(invalid_input) for words that do not name two of them.
std::vector<StructurePair> roi_rules(const SegmentCommand& command, const RoiDrawings& drawings);

}  // namespace kontur::app
