// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/derive/levels.h"

namespace kontur {

/// How far apart two places are: the root of the sum over the lattice's axes of (w d)^2, where d is the difference in mm and
/// w the weight of its direction. All weights 1: the distance in mm.
struct DirectedWeights {
    std::array<double, 3> towards_low{1, 1, 1}, towards_high{1, 1, 1};  ///< > 0

    bool operator==(const DirectedWeights&) const = default;
};

struct CrossingsDistanceOptions {
    Vec3 spacing_mm{1, 1, 1};  ///< of the lattice, whose axes are taken as orthogonal
    double reach = 0;          ///< farther points get infinity
    DirectedWeights weights{};
    int left_out_axis = -1;  ///< each slice across this axis by itself; -1: none
};

/// Of each point in the levels' box how far the nearest place is where the surface crosses a line of the lattice; on lines
/// these places lie anywhere between two points, and the distance is exact. Three transforms, one for the crossings along
/// each axis, whose first pass knows their places (after Felzenszwalb and Huttenlocher 2012). The cost is the box's size.
std::vector<float> crossings_distance(const Levels& levels, const CrossingsDistanceOptions& options, const Work& work);

}  // namespace kontur
