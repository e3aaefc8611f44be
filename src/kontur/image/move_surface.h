// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/image/follow_image.h"
#include "kontur/image/movement.h"

namespace kontur {

/// The surface through the contours, and how far the image moves it.
struct AskedSurface {
    std::vector<Vec3> points;  ///< close together
    double spacing_mm = 0;     ///< of the lattice that they are from
    Beliefs beliefs;           ///< with which the image was asked
    Movement movement;         ///< of some of them
};

AskedSurface ask_surface(const DrawnOnImage& drawn, const Drawing& drawing, const FittedFunction& fitted,
                         const Beliefs& beliefs, const ImageOptions& options, const Work& work);

/// Moves the surface to where the image shows the border, as far as that is believed, by one more solve. Verdict: used, or
/// astray.
ImageFit move_surface(AskedSurface asked, const DrawnOnImage& drawn, const Drawing& drawing,
                      const PreparedContours& prepared, const FittedFunction& fitted, const ImageOptions& options,
                      const Work& work);

}  // namespace kontur
