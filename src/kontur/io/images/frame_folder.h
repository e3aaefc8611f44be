// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/ and the applications: folders with a file for each frame.

#include <filesystem>
#include <functional>
#include <vector>

#include "kontur/shape/grid.h"

namespace kontur {

/// The images in a folder, a file for each frame, in the order in which people count their names; segmentations of 3D Slicer
/// and hidden files are none. Empty for what is no folder. Throws Error(io) for a folder that cannot be read.
std::vector<std::filesystem::path> frame_files(const std::filesystem::path& folder);

/// The grid that all files have. Throws Error(invalid_input), naming two files, where they have different ones, and what
/// `read` throws. Corners less than a thousandth of a voxel apart are the same.
Grid grid_of_frames(const std::vector<std::filesystem::path>& files,
                    const std::function<Grid(const std::filesystem::path&)>& read);

}  // namespace kontur
