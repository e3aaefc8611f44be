// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace kontur {

/// "1 contour", "2 contours": how many of what has a plural in s.
std::string counted(std::integral auto count, std::string_view thing) {
    std::string text = std::to_string(count) + ' ';
    text += thing;
    if (count != 1) text += 's';
    return text;
}

}  // namespace kontur
