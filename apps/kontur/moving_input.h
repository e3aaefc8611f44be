// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "files.h"
#include "kontur/base/work.h"
#include "kontur/io/images/frames.h"
#include "kontur/segment_moving.h"
#include "kontur/shape/contour.h"

namespace kontur::app {

/// What a command says of the image that contours of several moments were drawn on.
struct MovingWords {
    const ImageInput& image;
    std::optional<double> cycle;                ///< --cycle
    const std::string& frame_of_reference_uid;  ///< of the contours
};

/// That image: its frames, in the contours' unit of time.
struct MovingInput {
    ImageFrames frames;
    Grid grid;
    std::vector<double> times;
    std::vector<std::string> notes;

    /// With the voxels of each frame as they are asked for; `image` has to live as long.
    FramesToSegment to_segment(const ImageInput& image, const Work& work) const;
};

/// Gives the contours their cycle: that of --cycle, else their own, else the image's, which is noted. Throws
/// Error(invalid_input) where contours have seconds, and the image does not say how far apart its frames are.
MovingInput read_moving_input(const MovingWords& words, ContourSet& contours, const Work& work);

/// Throws Error(invalid_input) without an image, and where one of its frames is chosen.
void check_moving_image(const ImageInput& image);

}  // namespace kontur::app
