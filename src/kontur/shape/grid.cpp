// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "kontur/base/error.h"

namespace kontur {
namespace {

/// Beyond this a count of voxels as `double` is no longer exact, and far beyond any memory.
constexpr double kMaxVoxels = 9007199254740992.0;

/// Calls `visit` with the eight corners of the index box [low, high].
template <typename Visit>
void for_each_corner(const Vec3& low, const Vec3& high, const Visit& visit) {
    for (int corner = 0; corner < 8; ++corner)
        visit(Vec3{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z});
}

Vec3 last_index(const Grid& grid) {
    return {static_cast<double>(grid.size.i - 1), static_cast<double>(grid.size.j - 1),
            static_cast<double>(grid.size.k - 1)};
}

void check_spacing(const Vec3& spacing_mm) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(spacing_mm[axis] > 0) || !std::isfinite(spacing_mm[axis]))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("spacing along axis {} is {:g} mm; it must be above 0", axis + 1, spacing_mm[axis]));
}

}  // namespace

Vec3 Grid::spacing_mm() const {
    return {norm(index_to_mm.column(0)), norm(index_to_mm.column(1)), norm(index_to_mm.column(2))};
}

Box3 Grid::bounds_mm() const {
    const Vec3 half{0.5, 0.5, 0.5};
    Box3 box;
    for_each_corner(-half, last_index(*this) + half, [&](const Vec3& index) { box.extend(index_to_mm.apply(index)); });
    return box;
}

void check_grid(const Grid& grid) {
    double voxels = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] < 1)
            throw Error(ErrorKind::invalid_input, "the grid has " + std::to_string(grid.size[axis]) + " voxels along axis " +
                                                      std::to_string(axis + 1) + "; at least 1 is needed");
        voxels *= static_cast<double>(grid.size[axis]);
    }
    if (voxels > kMaxVoxels)
        throw Error(ErrorKind::too_large, "the grid has " + std::to_string(grid.size.i) + " x " +
                                              std::to_string(grid.size.j) + " x " + std::to_string(grid.size.k) +
                                              " voxels; at most 2^53 are possible");
    grid.index_to_mm.inverse();
    constexpr double kLeastSpacing = 1e-9, kMostSpacing = 1e9;  // beyond, products of three of them lose their digits
    for (int axis = 0; axis < 3; ++axis) {
        const double spacing = norm(grid.index_to_mm.column(axis));
        if (!(spacing >= kLeastSpacing && spacing <= kMostSpacing))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the voxels are {:g} mm apart along axis {}; {:g} to {:g} mm are possible", spacing,
                                    axis + 1, kLeastSpacing, kMostSpacing));
    }
}

Grid grid_around(const Box3& box, const Vec3& spacing_mm, double margin_mm) {
    check_spacing(spacing_mm);
    const Box3 covered = box.padded(margin_mm);
    if (box.is_empty() || covered.is_empty() || !is_finite(covered.min) || !is_finite(covered.max))
        throw Error(ErrorKind::invalid_input, "a grid needs a box with finite corners and a finite margin to cover");
    // Rounding noise in extent / spacing must not cost a voxel.
    constexpr double kNoise = 1e-9;
    Grid grid;
    double voxels = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double count = std::max(1.0, std::ceil(covered.size()[axis] / spacing_mm[axis] - kNoise));
        voxels *= count;
        if (voxels > kMaxVoxels)
            throw Error(ErrorKind::too_large,
                        fmt::format("a grid with a spacing of {:g} mm over {:g} mm has more than 2^53 voxels",
                                    spacing_mm[axis], covered.size()[axis]));
        grid.size[axis] = static_cast<std::int64_t>(count);
        grid.index_to_mm.linear[axis][axis] = spacing_mm[axis];
        grid.index_to_mm.translation[axis] = covered.center()[axis] - 0.5 * (count - 1) * spacing_mm[axis];
    }
    return grid;
}

double corner_distance_mm(const Grid& a, const Grid& b) {
    if (a.size != b.size) return std::numeric_limits<double>::infinity();
    double largest = 0;
    for_each_corner({}, last_index(a), [&](const Vec3& index) {
        largest = std::max(largest, distance(a.index_to_mm.apply(index), b.index_to_mm.apply(index)));
    });
    return largest;
}

}  // namespace kontur
