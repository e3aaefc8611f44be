// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"
#include "kontur/sureness/image_slice.h"

namespace kontur {

/// Parallel planes: those through origin + offset * normal.
struct PlaneStack {
    Vec3 normal;
    std::vector<double> offsets_mm;    ///< from 0 of the frame along the normal
    std::vector<ImageSlice> slices{};  ///< one for each offset where they are an image's
};

/// Directions of largest, middle and least extent, unit; their signs carry no meaning.
std::array<Vec3, 3> principal_axes(const std::vector<Vec3>& points);

/// Stacks of planes that cut the points: across the image's axes, its own slices, at most 24 of each; and, if any plane will
/// do, seven across each of 49 directions that lie evenly around the points' principal axes.
std::vector<PlaneStack> candidate_planes(const std::vector<Vec3>& points, PlaneChoice choice,
                                         const std::optional<Grid>& grid);

/// The second plane: at right angles to the longest contour's, along the long axis of its line, through the line's middle.
Plane plane_across(const ContourSet& contours);

}  // namespace kontur
