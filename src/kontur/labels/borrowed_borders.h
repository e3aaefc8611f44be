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

/// For each structure the points of borders that a neighbour alone has drawn. They are points of the neighbour's contours
/// in planes in which the structure has none. They lie nearer to the structure's surface than to the union's or any
/// other's. They lie nearer to it than three quarters of the distance to the structure's contours. There both have one
/// surface.
std::vector<std::vector<SurfacePoint>> borrowed_borders(const Neighbours& neighbours, const Work& work = {});

}  // namespace kontur
