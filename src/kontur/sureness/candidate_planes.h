// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"

namespace kontur {

enum class PlaneChoice {
    any,           ///< of any direction
    image_slices,  ///< voxel layers of the image across one of its three axes
};
std::string_view name(PlaneChoice choice) noexcept;

/// A layer of voxels.
struct Slice {
    int axis = 2;            ///< across which it lies: 0, 1 or 2 for i, j or k
    std::int64_t index = 0;  ///< from 0
    friend bool operator==(const Slice&, const Slice&) = default;
};

/// The plane through the voxel centres of a layer.
Plane slice_plane(const Grid& grid, const Slice& slice);

/// The layer whose plane is nearest to a point.
Slice nearest_slice(const Grid& grid, int axis, const Vec3& p);

/// Unit normal of the layers across an axis.
Vec3 slice_normal(const Grid& grid, int axis);

/// Parallel planes: those through origin + offset * normal.
struct PlaneStack {
    Vec3 normal;
    std::vector<double> offsets_mm;  ///< from 0 of the frame along the normal
    std::vector<Slice> slices{};     ///< one for each offset where they are an image's
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
