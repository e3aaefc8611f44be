// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// Structures that exclude each other and touch.
struct Neighbours {
    std::vector<const ContourSet*> drawn;
    std::vector<const ImplicitFunction*> functions;  ///< of each, fitted alone
    const ImplicitFunction* all = nullptr;           ///< of their union
};

/// For each structure the points of borders that a neighbour alone has drawn: points of the neighbour's contours in planes
/// in which the structure has none, that lie nearer to the structure's surface than to that of the union and than to any
/// other's, and nearer than three quarters as far as what was drawn of it. There the surface of the one is that of the
/// other.
std::vector<std::vector<SurfacePoint>> borrowed_borders(const Neighbours& neighbours, const Work& work = {});

}  // namespace kontur
