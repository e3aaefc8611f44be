// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/refine/movement.h"
#include "kontur/refine/refine.h"

namespace kontur {

/// The surface through the contours, and how far the image moves it.
struct AskedSurface {
    std::vector<Vec3> points;  ///< close together
    double spacing_mm = 0;     ///< of the lattice that they are from
    Beliefs beliefs;           ///< with which the image was asked
    Movement movement;         ///< of some of them
};

AskedSurface ask_surface(const DrawnOnImage& drawn, const Drawing& drawing, const FittedFunction& fitted,
                         const Beliefs& beliefs, const RefineOptions& options, const Work& work);

/// Moves the surface to where the image shows the border, as far as that is believed, by one more solve. Verdict: used, or
/// astray.
RefinedFunction move_surface(AskedSurface asked, const DrawnOnImage& drawn, const Drawing& drawing,
                             const PreparedContours& prepared, const FittedFunction& fitted, const RefineOptions& options,
                             const Work& work);

}  // namespace kontur
