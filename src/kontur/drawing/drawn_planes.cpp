// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/drawn_planes.h"

#include "kontur/shape/contour_nesting.h"

namespace kontur {

DrawnPlanes::DrawnPlanes(const ContourSet& drawn, const Ball3& around)
    : set(drawn),
      ball(around),
      tolerance_mm(1.5e-3 * ball.diameter()),
      sections(sections_of(drawn, kSamePlane * ball.diameter())) {}

std::optional<DrawnPlanes::Next> DrawnPlanes::next(const Plane& plane, double sign) const {
    std::optional<Next> nearest;
    for (const Section& other : sections) {
        const double ahead = sign * plane.distance_to(other.plane.origin);
        if (are_parallel(plane, other.plane) && ahead > tolerance_mm && (!nearest || ahead < nearest->distance_mm))
            nearest = Next{&other, ahead};
    }
    return nearest;
}

}  // namespace kontur
