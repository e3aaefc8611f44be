// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/level_mesh.h"

#include <algorithm>
#include <array>

#include "kontur/extract/polygonize.h"
#include "kontur/shape/index_box.h"

namespace kontur {
namespace {

/// Values on both sides of the cells that the surface passes, which is what normals need.
void set_values_around(SurfaceLattice& surface, const Levels& levels, const Index3& cell) {
    for (std::int64_t k = -1; k <= 2; ++k)
        for (std::int64_t j = -1; j <= 2; ++j)
            for (std::int64_t i = -1; i <= 2; ++i) {
                const Index3 at{cell.i + i, cell.j + j, cell.k + k};
                if (surface.lattice.in_grid(at))
                    surface.lattice.set_value(
                        at, levels.values[levels.offset(
                                {at.i + levels.box.low.i, at.j + levels.box.low.j, at.k + levels.box.low.k})]);
            }
}

}  // namespace

TriangleMesh level_mesh(const Levels& levels, const Grid& lattice, const Work& work) {
    if (is_empty(levels)) return {};
    const Index3 size = levels.box.size();
    SurfaceLattice surface{Lattice(grid_of(lattice, levels.box)), {}, 0};
    const std::array<std::int64_t, 3> steps{1, size.i, size.i * size.j};
    for (std::int64_t k = 0; k + 1 < size.k; ++k) {
        work.check();
        for (std::int64_t j = 0; j + 1 < size.j; ++j) {
            const float* row = levels.values.data() + size.i * (j + size.j * k);
            const auto inside_at = [&](std::int64_t i) {  // of four points, by bit
                const float* p = row + i;
                return static_cast<unsigned>(p[0] > 0) | static_cast<unsigned>(p[steps[1]] > 0) << 1 |
                       static_cast<unsigned>(p[steps[2]] > 0) << 2 | static_cast<unsigned>(p[steps[1] + steps[2]] > 0) << 3;
            };
            unsigned low = inside_at(0);
            for (std::int64_t i = 0; i + 1 < size.i; ++i) {
                const unsigned high = inside_at(i + 1);
                if ((low | high) != 0 && (low & high) != 15) surface.cells.push_back({i, j, k});
                low = high;
            }
        }
    }
    for (const Index3& cell : surface.cells) set_values_around(surface, levels, cell);
    return polygonize(surface);
}

}  // namespace kontur
