// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"

namespace kontur::viewer {

/// Where an image, or contours, come from.
struct Source {
    std::string frame_of_reference_uid{};  ///< DICOM's; "" where none is named
    std::string patient{};                 ///< for people; "" where the file does not say
};

/// Why these contours may not belong to the image, one sentence each, in words for the user; empty where nothing speaks
/// against it: they name another patient or frame of reference, or most points of a structure lie outside of the image (more
/// than `most_outside` of them, 0 to 1, farther than one voxel from it).
std::vector<std::string> import_doubts(const std::vector<ContourSet>& sets, const Source& drawn, const Grid& image,
                                       const Source& image_source, double most_outside = 0.5);

}  // namespace kontur::viewer
