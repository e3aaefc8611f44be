// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kontur {

/// A colour picture for people: 8 bits per channel, sRGB, rows from top to bottom, pixels from left to right, R G B.
struct RgbImage {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> bytes;  ///< 3 * width * height

    std::array<std::uint8_t, 3> at(int x, int y) const {
        const std::size_t o =
            3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
        return {bytes[o], bytes[o + 1], bytes[o + 2]};
    }

    friend bool operator==(const RgbImage&, const RgbImage&) = default;
};

}  // namespace kontur
