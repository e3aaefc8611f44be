// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/smallest_ball.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// A length in units of 1e-9 of the ball's radius, without what is less: the same for what differs by rounding alone.
double rounded(double mm, const Ball3& ball);

/// Lets a closed contour begin at its point that is farthest from the middle of the ball around all that was drawn, and run
/// towards the farther one of those beside it, however it was stored. Of points that are equally far away the one farthest
/// from the contour's own middle counts, then coordinates. What is computed from a contour may depend on where it begins by
/// rounding alone, or where it is so regular that nothing else tells its points apart.
void begin_alike(Contour& contour, const Ball3& ball);

}  // namespace kontur
