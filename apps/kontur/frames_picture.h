// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"
#include "kontur/io/images/frames.h"
#include "kontur/segment_moving.h"

namespace kontur::app {

/// A segmentation over time, with its surfaces.
struct SegmentedFrames {
    const SegmentCommand& command;
    const ContourSet& contours;
    const ImageFrames& frames;
    const MovingSegmentation& result;
};

/// The volume's curve with the frames of the largest and the smallest; in .apng all frames, one after the other.
void write_picture_of_frames(const std::filesystem::path& path, const SegmentedFrames& segmented,
                             const Provenance& provenance, const Work& work);

}  // namespace kontur::app
