// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/image_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/shape/contour.h"

namespace kontur {

ImageBox::ImageBox(const Grid& grid)
    : size_{static_cast<double>(grid.size.i), static_cast<double>(grid.size.j), static_cast<double>(grid.size.k)},
      to_index_(grid.index_to_mm.inverse()),
      to_mm_(grid.index_to_mm),
      voxel_mm_(largest(grid.spacing_mm())) {}

bool ImageBox::contains(const Vec3& place) const {
    const Vec3 index = to_index_.apply(place);
    for (int axis = 0; axis < 3; ++axis)
        if (!(index[axis] >= -0.5 && index[axis] <= size_[axis] - 0.5)) return false;
    return true;
}

bool ImageBox::contains(const ContourSet& set) const {
    const auto is_near = [&](const Vec3& place) {
        const Vec3 index = to_index_.apply(place);
        for (int axis = 0; axis < 3; ++axis)
            if (!(index[axis] >= -1 && index[axis] <= size_[axis])) return false;
        return true;
    };
    for (const Contour& contour : set.contours)
        if (!std::ranges::all_of(contour.points, is_near)) return false;
    return true;
}

Vec3 ImageBox::nearest(const Vec3& place) const {
    const Vec3 index = to_index_.apply(place);
    const auto inner = [&](int axis) { return std::clamp(index[axis], -0.5, size_[axis] - 0.5); };
    return to_mm_.apply({inner(0), inner(1), inner(2)});
}

double ImageBox::border_ahead_mm(const Vec3& place, const Vec3& direction) const {
    const Vec3 index = to_index_.apply(place), step = to_index_.apply_linear(direction);
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (step[axis] == 0) continue;
        const double voxels = step[axis] > 0 ? size_[axis] - 0.5 - index[axis] : index[axis] + 0.5;
        nearest = std::min(nearest, std::max(voxels, 0.0) / std::abs(step[axis]));
    }
    return nearest;
}

bool ImageBox::is_border(const Vec3& place, const Vec3& outward) const {
    constexpr double kAlong = 0.8;  // cosine
    const Vec3 index = to_index_.apply(place);
    for (int axis = 0; axis < 3; ++axis) {
        const auto& row = to_index_.linear[static_cast<std::size_t>(axis)];
        const double out = dot(normalized(Vec3{row[0], row[1], row[2]}), outward);
        const double slices = out > 0 ? size_[axis] - 0.5 - index[axis] : index[axis] + 0.5;
        if (std::abs(out) > kAlong && slices < 1) return true;
    }
    return false;
}

std::optional<ImageBox> image_of(const ContourSet& set, const std::optional<Grid>& image) {
    if (!image) return std::nullopt;
    const ImageBox box(*image);
    return box.contains(set) ? std::optional(box) : std::nullopt;
}

}  // namespace kontur
