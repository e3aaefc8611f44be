// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "kontur/base/geometry.h"
#include "kontur/shape/grid.h"

namespace kontur {

enum class PlaneChoice {
    any,           ///< of any direction
    image_slices,  ///< voxel layers of the image across one of its three axes
};
std::string_view name(PlaneChoice choice) noexcept;

/// A layer of voxels.
struct ImageSlice {
    int axis = 2;            ///< across which it lies: 0, 1 or 2 for i, j or k
    std::int64_t index = 0;  ///< from 0
    friend bool operator==(const ImageSlice&, const ImageSlice&) = default;
};

/// The plane through the voxel centres of a layer.
Plane slice_plane(const Grid& grid, const ImageSlice& slice);

/// The layer whose plane is nearest to a point.
ImageSlice nearest_slice(const Grid& grid, int axis, const Vec3& p);

/// Unit normal of the layers across an axis.
Vec3 slice_normal(const Grid& grid, int axis);

}  // namespace kontur
