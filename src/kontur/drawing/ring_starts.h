// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/smallest_ball.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// A length in units of 1e-9 of the ball's radius, without what is less: the same for what differs by rounding alone.
double rounded(double mm, const Ball3& ball);

/// Gives a closed contour a beginning and a direction that do not depend on how it was stored. It begins at the point
/// farthest from the middle of the ball around all contours, and runs towards the farther one of its neighbours. Ties go by
/// the distance from the contour's own middle, then by coordinates. Results may depend on the beginning by rounding alone,
/// or where the contour is so regular that nothing else tells its points apart.
void begin_alike(Contour& contour, const Ball3& ball);

}  // namespace kontur
