// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur::viewer {

/// The image's volumes in time.
struct FramesOfImage {
    int count = 1;
    int opened = 0;                  ///< from 0
    std::optional<double> step_s{};  ///< from one to the next, where the file says so
};

/// Contours that came with times as those of frames, from 1; those of one moment on an image of one frame lose it. Returns
/// what the user should know. Throws Error(invalid_input), naming the contour, for moments that the image does not have.
std::vector<std::string> put_into_frames(ContourSet& set, const FramesOfImage& frames);

/// As contours of a project have it: the frame from 0, unset for the one that was opened.
std::optional<int> time_of(const Contour& contour, const FramesOfImage& frames);

}  // namespace kontur::viewer
