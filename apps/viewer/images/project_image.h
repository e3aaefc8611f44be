// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viewer/images/opened_image.h"
#include "viewer/images/time_axis.h"
#include "viewer/images/views.h"

namespace kontur::viewer {

/// The image that a project is drawn on, and how it is shown at first. Nothing of it changes but which times are at hand.
struct ProjectImage {
    explicit ProjectImage(OpenedImage opened);

    std::shared_ptr<const Image> voxels;
    std::optional<double> frame_step_s;  ///< from one time to the next, where the file says so
    std::optional<double> cycle_frames;  ///< after which the motion repeats, likewise
    TimeAxis times;
    std::string title;
    std::string frame_of_reference_uid;
    std::optional<DicomSeries> series;
    DicomIdentity identity;
    std::vector<WindowPreset> presets;
    Window window;
    std::pair<double, double> range;
    bool shows_borders;  ///< no label map, nor the same value everywhere
    std::string unit;
};

}  // namespace kontur::viewer
