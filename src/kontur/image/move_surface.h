// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/image/follow_image.h"
#include "kontur/image/movement.h"

namespace kontur {

/// The surface through the contours, and how far the image moves it.
struct SurfaceMovement {
    std::vector<Vec3> points;  ///< close together
    double spacing_mm = 0;     ///< of the lattice that they are from
    Beliefs beliefs;           ///< with which the movement was found
    Movement movement;         ///< of some of them
};

/// `samples`: about so many points of the surface are moved.
SurfaceMovement surface_movement(const FittedDrawing& fit, const Surroundings& surroundings, const Beliefs& beliefs,
                                 std::size_t samples, const Work& work);

/// Moves the surface to where the image shows the border, as far as that is believed, by one more solve. Verdict: used, or
/// astray.
ImageFit move_surface(SurfaceMovement surface, const FittedDrawing& fit, const Surroundings& surroundings,
                      const FitOptions& options, const Work& work);

}  // namespace kontur
