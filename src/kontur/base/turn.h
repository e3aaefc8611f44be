// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/geometry.h"

namespace kontur {

/// v, turned as the shortest turn takes the unit vector `from` to the unit vector `to` (Rodrigues). Opposite ones have no
/// shortest turn, and v stays.
inline Vec3 turned(const Vec3& v, const Vec3& from, const Vec3& to) {
    constexpr double kOpposite = -0.999;  // cosine
    const double cosine = dot(from, to);
    if (cosine < kOpposite) return v;
    const Vec3 axis = cross(from, to);
    return v + cross(axis, v) + cross(axis, cross(axis, v)) / (1 + cosine);
}

}  // namespace kontur
