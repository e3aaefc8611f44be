// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "kontur/base/geometry.h"

namespace kontur {

/// A point of the surface that may move along its normal, and what is known of how far before the image is looked at.
struct MovingPoint {
    Vec3 position;                                               ///< mm
    Vec3 normal;                                                 ///< unit, outward
    double distance_mm = 0;                                      ///< to the nearest contour
    double prior_mm = 0;                                         ///< standard deviation of its offset
    double least_mm = -std::numeric_limits<double>::infinity();  ///< where it would cross a drawn plane, backwards
    double most_mm = std::numeric_limits<double>::infinity();    ///< and forwards
};

}  // namespace kontur
