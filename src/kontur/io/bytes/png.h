// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "kontur/shape/provenance.h"
#include "kontur/shape/rgb_image.h"

namespace kontur {

/// Writes the picture as an 8-bit sRGB PNG, whole or not at all; the same picture gives the same bytes.
/// `provenance` goes into text chunks, each with the keyword "kontur NAME". Throws Error(invalid_input) for a picture
/// without pixels or with a wrong number of bytes, Error(io) naming file and reason.
void write_png(const std::filesystem::path& path, const RgbImage& image, const Provenance& provenance = {});

/// The bytes of such a file, for what shows pictures without files. Errors as `write_png`'s but for io.
std::string encode_png(const RgbImage& image, const Provenance& provenance = {});

/// Pictures of one size as one that moves (APNG), again and again; programs that know no APNG show the first one. Each is
/// seen for `seconds`, to a millisecond. Throws as `write_png`, and Error(invalid_input) without a picture, for pictures of
/// different sizes, and for a time that is not above 0 and at most 60.
void write_animated_png(const std::filesystem::path& path, std::span<const RgbImage> pictures, double seconds,
                        const Provenance& provenance = {});

}  // namespace kontur
