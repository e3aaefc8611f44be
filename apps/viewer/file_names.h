// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace kontur::viewer {

/// A structure's name without what any system or header would stumble over; "structure" for an empty one.
std::string plain_name(const std::string& name);

/// Red, green and blue from 0 to 1 of "#rrggbb".
std::array<double, 3> rgb(const std::string& color);

}  // namespace kontur::viewer
