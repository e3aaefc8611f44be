// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "kontur/shape/volume.h"

namespace kontur::viewer {

/// All of the slice in the middle, its longer side in so many pixels, in shades of the image's own window: a binary reply
/// with the array `pixels`, and `width`, `height` beside the members of `header`.
std::string slice_picture(const Image& image, int pixels, nlohmann::json header = nlohmann::json::object());

}  // namespace kontur::viewer
