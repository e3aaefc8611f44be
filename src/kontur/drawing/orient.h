// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// A contour's outward side (paper section 5.1).
struct ContourOrientation {
    /// Unit in-plane normals, one per point, pointing out of the object (for a hole: into the cavity). At the tip of a
    /// spike that folds back on itself Eq. 7 has no answer; there the normal points along the spike, out of its tip or,
    /// where the spike is a cut into the object, out of the cut.
    std::vector<Vec3> normals;
    /// Points in mm where the contour crosses itself; where it only touches itself it does not.
    std::vector<Vec3> crossings;
    /// Points in mm on the stretches between two crossings that hold no point of the contour: edges of lobes without one.
    std::vector<Vec3> between_crossings;
};

/// Normals by Eq. 7. Their sign is known at the point of smallest in-plane coordinate, which is surely convex. From there it
/// is walked along the contour, and flipped wherever a segment crosses others an odd number of times. So both lobes of a
/// figure of eight get outward normals, as under the even-odd rule. Where a contour runs through its own points or segments,
/// the sign is flipped as if its points were displaced infinitesimally. Decisions are exact on the in-plane coordinates.
/// Needs at least 3 points of which none repeats the one before it. O(n log n) for n points of which few lie side by side.
/// Throws Error(invalid_input) for fewer.
ContourOrientation orient(const Contour& contour);

/// Unit in-plane normals of an open contour, one per point, to the left of someone who walks along it (Eq. 7; at the ends
/// the normal of the only edge). At the tip of a spike, where the answer is not defined, the zero vector.
std::vector<Vec3> left_normals(const Contour& contour);

}  // namespace kontur
