// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/phantom/bodies.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// A contour set of the phantom with everything needed to judge a segmentation made from it.
struct PhantomCase {
    std::string name;
    std::string note;          ///< one sentence: what it is and what it is for
    std::optional<Body> body;  ///< the truth; none for the self-intersecting curves
    ContourSet contours;  ///< points equally spaced along each contour, exactly on their planes and on the body's surface
    Grid grid;            ///< the lattice to segment on
    /// Unit outward surface normals of the body at (for hand-drawn variants: near) each contour's points. Without a body:
    /// the in-plane normals towards the outside by the even-odd rule.
    std::vector<std::vector<Vec3>> normals;
};

/// Names of all cases. Those ending in "_hand" displace the points of the case they are named after within their planes as
/// an unsteady hand does: 0.6 mm rms (metastasis and vertebra 0.24 mm) in waves along the contour and a little jitter.
std::vector<std::string> phantom_case_names();

/// The case of that name, always the same. Throws Error(invalid_input) for a name that is none.
PhantomCase phantom_case(std::string_view name);

}  // namespace kontur
