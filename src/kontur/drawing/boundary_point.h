// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "kontur/base/geometry.h"

namespace kontur {

inline constexpr std::int32_t kNoContour = -1;

/// A point of the surface that takes part in the fit, with what was drawn of the surface's direction there.
struct BoundaryPoint {
    Vec3 position;           ///< mm
    Vec3 inplane_normal{};   ///< unit, outward, in the contour's plane (Eq. 7); zero: not known, no normal constraint
    Vec3 plane_normal{};     ///< unit normal of the contour's plane: where the surface may tilt; zero: it may not
    std::int32_t contour{};  ///< index into ContourSet::contours; kNoContour for a single point
    double trust = 1;        ///< > 0: how closely the surface is to follow, against smoothness
    double gap_mm = std::numeric_limits<double>::infinity();    ///< along the normal to the next drawn line of the plane
    double depth_mm = std::numeric_limits<double>::infinity();  ///< the same against the normal
    double extent = 1;      ///< in (0, 1], of the part of the drawing that it belongs to, over that of the whole (Extents)
    std::int32_t line = 0;  ///< tells the lines of one contour apart: its own is 0, others are those of its lid
    bool on_ring = false;   ///< its line is closed: the first point follows the last one
};

}  // namespace kontur
