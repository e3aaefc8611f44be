// SPDX-License-Identifier: Apache-2.0
#include "labels_on_grid.h"

#include <cmath>

namespace kontur::app {
namespace {

bool contains(const Index3& size, const Vec3& nearest) {
    const auto within = [](double index, std::int64_t count) { return index >= 0 && index < static_cast<double>(count); };
    return within(nearest.x, size.i) && within(nearest.y, size.j) && within(nearest.z, size.k);
}

}  // namespace

Image labels_on_grid(const Image& labels, const Grid& grid) {
    check_image(labels);
    check_grid(grid);
    const Affine3 mm_to_index = labels.grid.index_to_mm.inverse();
    return std::visit(
        [&](const auto& samples) {
            std::decay_t<decltype(samples)> values(static_cast<std::size_t>(grid.voxel_count()));
            for (std::int64_t k = 0; k < grid.size.k; ++k)
                for (std::int64_t j = 0; j < grid.size.j; ++j)
                    for (std::int64_t i = 0; i < grid.size.i; ++i) {
                        const Vec3 index = mm_to_index.apply(grid.center_mm(i, j, k));
                        const Vec3 nearest{std::round(index.x), std::round(index.y), std::round(index.z)};
                        if (!contains(labels.grid.size, nearest)) continue;
                        values[grid.offset(i, j, k)] = samples[labels.grid.offset(static_cast<std::int64_t>(nearest.x),
                                                                                  static_cast<std::int64_t>(nearest.y),
                                                                                  static_cast<std::int64_t>(nearest.z))];
                    }
            return Image{grid, std::move(values)};
        },
        labels.samples);
}

}  // namespace kontur::app
