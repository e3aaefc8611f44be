// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/geometry.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// Axes of unit length that turn and move with a drawing, by its longest contour: from its middle towards its first point
/// (begin_alike), and across its plane. What is chosen in it is chosen alike however the drawing lies and is stored. The
/// patient's axes where there is none.
Affine3 frame_of(const ContourSet& contours);

/// The same set in an order that does not depend on how it was stored: contours by their middles along the z of its frame,
/// as in a stack, and rings with the beginning that begin_alike says.
ContourSet stored_alike(ContourSet set);

}  // namespace kontur
