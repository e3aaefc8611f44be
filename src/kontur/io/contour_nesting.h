// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: which contours of a slice lie inside others.

#include <cstddef>
#include <utility>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

struct Nesting {
    std::vector<std::size_t> depth;                              ///< per contour: how many others on its plane enclose it
    std::vector<std::pair<std::size_t, std::size_t>> crossings;  ///< pairs of which one lies partly inside the other
};

/// Contours count as on one plane when their planes are equal. Points within `tolerance_mm` of the other contour count as
/// neither inside nor outside. Quadratic in the contours and points of a plane.
Nesting find_nesting(const std::vector<Contour>& contours, double tolerance_mm);

}  // namespace kontur
