// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/surface_voxels.h"

#include <fmt/format.h>

#include "kontur/base/error.h"

namespace kontur {
namespace {

bool is_surface(const Grid& grid, const std::vector<std::uint8_t>& inside, const Index3& at) {
    const Index3& size = grid.size;
    const std::size_t n = grid.offset(at.i, at.j, at.k);
    const std::size_t row = static_cast<std::size_t>(size.i), slice = row * static_cast<std::size_t>(size.j);
    const auto outside = [&](std::size_t offset) { return inside[offset] == 0; };
    return at.i == 0 || at.j == 0 || at.k == 0 || at.i + 1 == size.i || at.j + 1 == size.j || at.k + 1 == size.k ||
           outside(n - 1) || outside(n + 1) || outside(n - row) || outside(n + row) || outside(n - slice) ||
           outside(n + slice);
}

}  // namespace

void check_comparable(const Mask& a, const Mask& b) {
    constexpr double kLimitMm = 1e-3;
    check_mask(a, "the first mask");
    check_mask(b, "the second mask");
    const auto differ = [](const std::string& how) {
        throw Error(ErrorKind::invalid_input, "the masks lie on different grids: " + how);
    };
    const Index3 &of_a = a.grid.size, &of_b = b.grid.size;
    if (of_a != of_b)
        differ(fmt::format("{} x {} x {} and {} x {} x {} voxels", of_a.i, of_a.j, of_a.k, of_b.i, of_b.j, of_b.k));
    const double apart = corner_distance_mm(a.grid, b.grid);
    if (!(apart <= kLimitMm))
        differ(fmt::format("corner voxels are up to {:.4g} mm apart; the limit is {:g} mm", apart, kLimitMm));
}

std::vector<Vec3> surface_voxels(const Grid& grid, const std::vector<std::uint8_t>& inside) {
    std::vector<Vec3> points;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                if (inside[grid.offset(i, j, k)] != 0 && is_surface(grid, inside, {i, j, k}))
                    points.push_back(grid.center_mm(i, j, k));
    return points;
}

}  // namespace kontur
