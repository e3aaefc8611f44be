// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/geometry.h"

namespace kontur {

/// The same map with its result's axes turned by the signs given: {-1, -1, 1} turns RAS into LPS and back. Internal to io.
inline Affine3 with_axes_turned(Affine3 affine, const Vec3& signs) {
    for (int row = 0; row < 3; ++row) {
        for (double& value : affine.linear[static_cast<std::size_t>(row)]) value *= signs[row];
        affine.translation[row] *= signs[row];
    }
    return affine;
}

inline Affine3 ras_to_lps(const Affine3& affine) { return with_axes_turned(affine, {-1, -1, 1}); }
inline Affine3 lps_to_ras(const Affine3& affine) { return with_axes_turned(affine, {-1, -1, 1}); }

/// The same map in other units: all lengths times `factor`.
inline Affine3 scaled(Affine3 affine, double factor) {
    for (auto& row : affine.linear)
        for (double& value : row) value *= factor;
    affine.translation *= factor;
    return affine;
}

}  // namespace kontur
