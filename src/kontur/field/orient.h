// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// A contour's outward side (paper section 5.1).
struct ContourOrientation {
    /// Unit in-plane normals, one per point, pointing out of the object (for a hole: into the cavity). At a point where
    /// Eq. 7 has no answer (a spike that folds back on itself, a repeated point) the bisector of the two edges'
    /// directions away from the spike's tip is taken.
    std::vector<Vec3> normals;
    /// Points in mm where the contour crosses itself.
    std::vector<Vec3> crossings;
};

/// Normals by Eq. 7, their sign walked along the contour from its point of smallest in-plane coordinate, which is surely
/// convex, and flipped wherever a segment crosses others an odd number of times: both lobes of a figure of eight get
/// outward normals, as under the even-odd rule. Needs at least 3 points.
ContourOrientation orient(const Contour& contour);

}  // namespace kontur
