// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

/// The line between the control points of 3D Slicer's curves, of which the file says nothing.
enum class Curves {
    spline,   ///< as 3D Slicer draws a new curve
    polygon,  ///< straight, as in its curves of type linear
};

/// "spline" or "polygon".
constexpr std::string_view name(Curves curves) { return curves == Curves::spline ? "spline" : "polygon"; }

}  // namespace kontur
