// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/shape/grid.h"

namespace kontur {

struct ContourSet;

/// The box of the voxels that were drawn on. Beyond it nothing was seen of the object, so nothing is known there.
class ImageBox {
public:
    /// Throws Error(invalid_input) as Affine3::inverse.
    explicit ImageBox(const Grid& grid);

    /// The longest edge of a voxel.
    double voxel_mm() const { return voxel_mm_; }
    /// Whether a place lies within the outer faces of the voxels.
    bool contains(const Vec3& place) const;
    /// Whether all lines of a set do, up to half a voxel.
    bool contains(const ContourSet& set) const;
    /// The place of the box that is nearest in voxels.
    Vec3 nearest(const Vec3& place) const;
    /// From a place in the box along a unit vector to its faces; 0 from beyond it.
    double border_ahead_mm(const Vec3& place, const Vec3& direction) const;
    /// Whether a line runs along a face, less than a slice from it: there the image ends and not the object. `outward` is
    /// the unit normal of the line.
    bool is_border(const Vec3& place, const Vec3& outward) const;

private:
    Vec3 size_;
    Affine3 to_index_, to_mm_;
    double voxel_mm_;
};

/// The box of an image that a set was drawn on; none where lines of it run outside: it was drawn on another one.
std::optional<ImageBox> image_of(const ContourSet& set, const std::optional<Grid>& image);

}  // namespace kontur
