// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// Points spread evenly over a fitted surface, each for a patch of it, so that sums over them are integrals.
struct SurfaceSamples {
    std::vector<Vec3> points;       ///< mm
    std::vector<double> areas_mm2;  ///< of the patches
    std::vector<double> slopes;     ///< |grad f| at the points, about 1 where f is like a distance

    double area_mm2() const;
};

}  // namespace kontur
