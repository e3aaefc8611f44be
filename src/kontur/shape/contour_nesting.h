// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// Which closed contours of a plane lie inside others. Open contours enclose nothing and are enclosed by nothing.
struct Nesting {
    std::vector<std::size_t> depth;                   ///< per contour: how many others on its plane enclose it
    std::vector<std::vector<std::size_t>> enclosing;  ///< per contour: which ones they are, in ascending order
    std::vector<std::pair<std::size_t, std::size_t>>
        crossings;  ///< pairs of which one lies partly inside the other, or on it
};

/// Of a set's diameter: points this near to a plane lie in it. More than files round their coordinates by, less than slices
/// are apart.
inline constexpr double kSamePlane = 3e-4;

/// The contours' indices, those with the largest boxes first: the larger one knows its plane better.
std::vector<std::size_t> largest_first(const std::vector<Contour>& contours);

/// For each contour whose plane it lies in with all its points within `tolerance_mm`: that of a larger one, else its own.
std::vector<std::size_t> shared_planes(const std::vector<Contour>& contours, double tolerance_mm);

/// Contours in one plane (shared_planes) are compared. Points within `tolerance_mm` of the other contour count as neither
/// inside nor outside. O(n log n) in contours few of which lie in each other; of each at most 2000 points are tested.
Nesting find_nesting(const std::vector<Contour>& contours, double tolerance_mm);

/// Whether a contour lies in a plane with all its points within `tolerance_mm`, and was not drawn across it.
bool lies_in(const Contour& contour, const Plane& plane, double tolerance_mm);

}  // namespace kontur
