// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kontur/shape/contour.h"

namespace kontur::test {

/// Rotation about an oblique axis, then a shift far from the origin.
inline Affine3 rigid_motion() {
    const double a = 0.7, b = -0.4;
    Affine3 about_z, about_x;
    about_z.linear = {{{std::cos(a), -std::sin(a), 0}, {std::sin(a), std::cos(a), 0}, {0, 0, 1}}};
    about_x.linear = {{{1, 0, 0}, {0, std::cos(b), -std::sin(b)}, {0, std::sin(b), std::cos(b)}}};
    Affine3 motion = compose(about_x, about_z);
    motion.translation = {140, -230, 710};
    return motion;
}

inline ContourSet moved(ContourSet set, const Affine3& motion) {
    for (Contour& contour : set.contours) {
        for (Vec3& p : contour.points) p = motion.apply(p);
        contour.plane = {motion.apply(contour.plane.origin), motion.apply_linear(contour.plane.normal),
                         motion.apply_linear(contour.plane.u), motion.apply_linear(contour.plane.v)};
    }
    return set;
}

}  // namespace kontur::test
