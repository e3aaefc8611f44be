// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace kontur::viewer {

/// A structure's name without what any system or header would stumble over; "structure" for an empty one.
std::string plain_name(const std::string& name);

/// Red, green and blue from 0 to 1 of "#rrggbb".
std::array<double, 3> rgb(const std::string& color);

/// The same from 0 to 255, and back.
std::array<std::uint8_t, 3> rgb8(const std::string& color);
std::string color_text(const std::array<std::uint8_t, 3>& levels);

}  // namespace kontur::viewer
