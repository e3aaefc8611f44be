// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "files.h"
#include "kontur/base/work.h"
#include "kontur/refine/refine.h"

namespace kontur::app {

/// What was drawn on: its grid and, where they are asked and can be read, its voxels.
struct DrawnOn {
    Grid grid;
    std::optional<Image> image;
};

/// Where the voxels cannot be read the grid will do; then a note says that the image is not used, and why.
DrawnOn read_drawn_on(const ImageInput& input, UseImage use, const Work& work, std::vector<std::string>& notes);

}  // namespace kontur::app
