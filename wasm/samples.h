// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kontur/shape/volume.h"

namespace kontur::wasm {

/// A copy of a typed array, `type` its name in JavaScript, as an image on the grid. Throws Error(unsupported) for other
/// types.
Image image_from(const void* samples, std::string_view type, const Grid& grid);

/// The bytes of an image's samples.
std::vector<std::uint8_t> bytes_of(const Image& image);

/// The name of its samples' typed array.
std::string_view type_of(const Image& image);

}  // namespace kontur::wasm
