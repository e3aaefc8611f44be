// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/contour.h"

/// Drawings that cross themselves. Internal to the phantom.
namespace kontur {

struct SelfIntersectingCurves {
    ContourSet contours;
    std::vector<std::vector<Vec3>> normals;  ///< unit, in-plane, towards the outside by the even-odd rule
};

/// Figures of eight (Gerono's lemniscate) in 5 axial planes and, beside them, loops within loops (Pascal's limacon) in the
/// same 5 planes. By the even-odd rule an eight has two lobes and the inner loop is a hole.
SelfIntersectingCurves self_intersecting_curves();

}  // namespace kontur
