// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

/// What contours inside others mean.
enum class FillRule {
    even_odd,  ///< a contour inside an odd number of others is a hole, as is every contour declared to be one
    declared,  ///< only declared contours are holes; others inside the object add nothing to it
};
std::string_view name(FillRule rule) noexcept;

}  // namespace kontur
