// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/frames.h"

#include <numbers>

#include "kontur/phantom/bodies.h"

namespace kontur {
namespace {

Vec3 middle_index(const Index3& size) {
    return {0.5 * static_cast<double>(size.i - 1), 0.5 * static_cast<double>(size.j - 1),
            0.5 * static_cast<double>(size.k - 1)};
}

Grid grid_centered_at(const Vec3& center, const Index3& size, const Vec3& spacing_mm) {
    Grid grid{size, {}};
    for (int axis = 0; axis < 3; ++axis) grid.index_to_mm.linear[axis][axis] = spacing_mm[axis];
    grid.index_to_mm.translation = center - grid.index_to_mm.apply_linear(middle_index(size));
    return grid;
}

/// Rotation in the plane of the axes after `axis`.
Affine3 rotation(int axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    Affine3 turn;
    turn.linear[a][a] = turn.linear[b][b] = std::cos(angle);
    turn.linear[b][a] = std::sin(angle);
    turn.linear[a][b] = -std::sin(angle);
    return turn;
}

}  // namespace

Grid liver_grid() { return grid_centered_at(liver().bounds().center(), {341, 311, 101}, {0.62, 0.62, 1.8}); }

Grid metastasis_grid() { return grid_centered_at(metastasis().bounds().center(), {99, 99, 108}, {0.56, 0.56, 0.56}); }

Grid oblique(const Grid& grid) {
    const Vec3 center = grid.index_to_mm.apply(middle_index(grid.size));
    const Affine3 turn = compose(rotation(2, 5), compose(rotation(1, 10), rotation(0, 20)));
    Grid turned = grid;
    for (int axis = 0; axis < 3; ++axis)
        turned.index_to_mm.set_column(axis, turn.apply_linear(grid.index_to_mm.column(axis)));
    turned.index_to_mm.translation = center - turned.index_to_mm.apply_linear(middle_index(grid.size));
    return turned;
}

}  // namespace kontur
