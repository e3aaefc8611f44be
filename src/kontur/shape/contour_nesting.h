// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// Which closed contours of a plane lie inside others. Open contours enclose nothing and have depth 0.
struct Nesting {
    std::vector<std::size_t> depth;                              ///< per contour: how many others on its plane enclose it
    std::vector<std::vector<std::size_t>> enclosing;             ///< per contour: which ones they are, in ascending order
    std::vector<std::pair<std::size_t, std::size_t>> crossings;  ///< pairs of which one lies partly inside the other
};

/// Planes less than `tolerance_mm` apart whose normals agree up to sign are one. Points within `tolerance_mm` of the other
/// contour count as neither inside nor outside. Quadratic in the contours and points of a plane.
Nesting find_nesting(const std::vector<Contour>& contours, double tolerance_mm);

/// Whether two planes are one: normals equal up to sign, the second's origin less than `tolerance_mm` off the first.
bool coincide(const Plane& a, const Plane& b, double tolerance_mm);

}  // namespace kontur
