// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/function_levels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "kontur/base/parallel.h"
#include "kontur/extract/find_surface.h"

namespace kontur {
namespace {

constexpr double kBeyondImageMm = 30;  ///< so far an object that the image cuts off is followed
constexpr double kFarSteps = 1.5;      ///< level where the surface is at least a step away and nobody evaluated the function
constexpr double kLeastSteps = 0.01;   ///< level where the mask contradicts the function

struct BorderEdges {
    std::optional<IndexBox> inside;  ///< of the voxels inside
    std::vector<Vec3> starts;        ///< mm; half way between voxels inside and outside, within the slices of the image
};

BorderEdges border_edges(const Mask& mask, int thick_axis) {
    BorderEdges found;
    const Grid& grid = mask.grid;
    const Index3 size = grid.size;
    const std::int64_t steps[] = {1, size.i, size.i * size.j};
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j)
            for (std::int64_t i = 0; i < size.i; ++i) {
                const Index3 at{i, j, k};
                const std::uint8_t* here = mask.values.data() + grid.offset(i, j, k);
                if (*here) found.inside = found.inside ? box_around(*found.inside, {at, at}) : IndexBox{at, at};
                for (int axis = 0; axis < 3; ++axis) {
                    if (axis == thick_axis || at[axis] + 1 >= size[axis]) continue;
                    if ((*here != 0) == (here[steps[axis]] != 0)) continue;
                    Vec3 index{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
                    index[axis] += 0.5;
                    found.starts.push_back(grid.index_to_mm.apply(index));
                }
            }
    return found;
}

/// On the lattice, with two steps to spare, and more where the object goes on beyond the image.
IndexBox searched_box(const IndexBox& inside, const Grid& image, const WorkLattice& lattice) {
    const Index3 steps = steps_per_voxel(lattice);
    const Vec3 spacing = lattice.grid.spacing_mm();
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const auto beyond = static_cast<std::int64_t>(std::ceil(kBeyondImageMm / spacing[axis]));
        const std::int64_t around = 2 * steps[axis];
        box.low[axis] = inside.low[axis] * steps[axis] - (inside.low[axis] == 0 ? beyond : around);
        box.high[axis] = inside.high[axis] * steps[axis] + (inside.high[axis] + 1 == image.size[axis] ? beyond : around);
    }
    return box;
}

void follow_mask(Levels& levels, const Mask& mask, const WorkLattice& lattice) {
    const Index3 steps = steps_per_voxel(lattice);
    const auto least = static_cast<float>(kLeastSteps * shortest_step(lattice.grid));
    for (std::int64_t k = 0; k < mask.grid.size.k; ++k)
        for (std::int64_t j = 0; j < mask.grid.size.j; ++j)
            for (std::int64_t i = 0; i < mask.grid.size.i; ++i) {
                const Index3 at{i * steps.i, j * steps.j, k * steps.k};
                if (!levels.box.contains(at)) continue;
                float& level = levels.values[levels.offset(at)];
                const bool inside = mask.values[mask.grid.offset(i, j, k)] != 0;
                if ((level > 0) != inside) level = inside ? least : -least;
            }
}

}  // namespace

Levels function_levels(const ImplicitFunction& function, const Mask& mask, const WorkLattice& lattice, const Work& work) {
    check_mask(mask);
    const BorderEdges border = border_edges(mask, lattice.thick_axis);
    if (!border.inside) return {};
    const IndexBox box = searched_box(*border.inside, mask.grid, lattice);
    const SurfaceLattice surface =
        find_surface(function, grid_of(lattice.grid, box), border.starts, Voxelizer::adaptive, work.untold());
    const Mask inside = fill(surface, work.untold());

    Levels levels{grown(box, {1, 1, 1}), {}};
    const Index3 size = levels.box.size(), found = box.size();
    const auto far = static_cast<float>(kFarSteps * shortest_step(lattice.grid));
    levels.values.assign(static_cast<std::size_t>(size.i * size.j * size.k), -far);
    parallel_for(found.j * found.k, 64, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row)
            for (std::int64_t i = 0; i < found.i; ++i) {
                const Index3 at{i, row % found.j, row / found.j};
                const bool is_inside = inside.values[static_cast<std::size_t>(i + found.i * row)] != 0;
                const double value = surface.lattice.value(at);
                float level = is_inside ? far : -far;
                if (!std::isnan(value) && (value > 0) == is_inside)
                    level = static_cast<float>(std::clamp(value, -static_cast<double>(far), static_cast<double>(far)));
                levels.values[levels.offset({box.low.i + at.i, box.low.j + at.j, box.low.k + at.k})] = level;
            }
    });
    follow_mask(levels, mask, lattice);
    return trimmed(std::move(levels));
}

}  // namespace kontur
