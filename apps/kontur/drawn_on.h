// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "files.h"
#include "kontur/base/work.h"
#include "kontur/image/follow_image.h"
#include "kontur/io/image.h"

namespace kontur::app {

/// The voxels; none, and a sentence that tells why, where the file is there but cannot be read.
std::optional<Image> readable_image(const ImageInput& input, const Work& work, std::string& sentence);

/// What was drawn on: its grid and, where they are asked and can be read, its voxels.
struct DrawnOn {
    Grid grid;
    std::optional<Image> image;
};

/// Where the voxels cannot be read the grid will do.
DrawnOn read_drawn_on(const ImageInput& input, UseImage use, const Work& work, std::vector<std::string>& notes);

}  // namespace kontur::app
