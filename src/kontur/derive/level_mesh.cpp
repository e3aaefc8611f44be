// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/level_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "kontur/extract/polygonize.h"
#include "kontur/shape/index_box.h"

namespace kontur {
namespace {

/// Values on both sides of the cells that the surface passes, which is what normals need; each once, as cells beside each
/// other have most of them in common.
void set_values_around(SurfaceLattice& surface, const Levels& levels) {
    std::vector<std::uint8_t> is_set(levels.values.size());
    const Index3 size = levels.box.size();
    for (const Index3& cell : surface.cells)
        for (std::int64_t k = std::max<std::int64_t>(cell.k - 1, 0); k <= std::min(cell.k + 2, size.k - 1); ++k)
            for (std::int64_t j = std::max<std::int64_t>(cell.j - 1, 0); j <= std::min(cell.j + 2, size.j - 1); ++j)
                for (std::int64_t i = std::max<std::int64_t>(cell.i - 1, 0); i <= std::min(cell.i + 2, size.i - 1); ++i) {
                    const auto at = static_cast<std::size_t>(i + size.i * (j + size.j * k));
                    if (std::exchange(is_set[at], 1) == 0) surface.lattice.set_value({i, j, k}, levels.values[at]);
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
    set_values_around(surface, levels);
    return polygonize(surface);
}

}  // namespace kontur
