// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

/// What the normal constraints know of the surface's direction.
enum class Normals {
    surface,   ///< its tilt against each contour's plane, found from all contours together
    in_plane,  ///< only what each contour shows (Eq. 7): the paper's; leaks where contours of different planes cross
};
std::string_view name(Normals normals) noexcept;

}  // namespace kontur
