// SPDX-License-Identifier: Apache-2.0
#include "labels_on_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/error.h"

namespace kontur::app {
namespace {

bool contains(const Index3& size, const Vec3& nearest) {
    const auto within = [](double index, std::int64_t count) { return index >= 0 && index < static_cast<double>(count); };
    return within(nearest.x, size.i) && within(nearest.y, size.j) && within(nearest.z, size.k);
}

/// Slices of the labels against those of the grid.
struct SliceAxis {
    int axis = 2;     ///< of the labels' slices
    double step = 1;  ///< of the grid's slices, in units of theirs
};

/// Steps of the grid in units of the labels' indices, one in a column.
Affine3 steps_of(const Image& labels, const Grid& grid) {
    const Affine3 mm_to_index = labels.grid.index_to_mm.inverse();
    Affine3 steps;
    for (int n = 0; n < 3; ++n) steps.set_column(n, mm_to_index.apply_linear(grid.index_to_mm.column(n)));
    return steps;
}

SliceAxis slice_axis(const Image& labels, const Grid& grid) {
    const Affine3 steps = steps_of(labels, grid);
    SliceAxis found{2, std::numeric_limits<double>::infinity()};
    for (int axis = 2; axis >= 0; --axis) {
        double step = 0;
        for (int n = 0; n < 3; ++n) step = std::max(step, std::abs(steps.column(n)[axis]));
        if (step < found.step - 1e-9) found = {axis, step};
    }
    // A slice of the grid must not leave the slice of the labels over its whole width.
    int across = 0;
    for (int n = 0; n < 3; ++n)
        if (std::abs(steps.column(n)[found.axis]) * static_cast<double>(grid.size[n]) > 0.5 * found.step) ++across;
    if (across > 1) throw Error(ErrorKind::invalid_input, "its slices are not parallel to those of the image");
    return found;
}

/// `is_kept` is asked for the place of each voxel of the grid among the labels' indices.
template <class IsKept>
Image resampled(const Image& labels, const Grid& grid, const IsKept& is_kept) {
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
                        if (!contains(labels.grid.size, nearest) || !is_kept(index)) continue;
                        values[grid.offset(i, j, k)] = samples[labels.grid.offset(static_cast<std::int64_t>(nearest.x),
                                                                                  static_cast<std::int64_t>(nearest.y),
                                                                                  static_cast<std::int64_t>(nearest.z))];
                    }
            return Image{grid, std::move(values)};
        },
        labels.samples);
}

}  // namespace

Image labels_on_grid(const Image& labels, const Grid& grid) {
    return resampled(labels, grid, [](const Vec3&) { return true; });
}

Image slices_on_grid(const Image& labels, const Grid& grid) {
    const SliceAxis slices = slice_axis(labels, grid);
    return resampled(labels, grid, [&](const Vec3& index) {
        const double beside = index[slices.axis] - std::round(index[slices.axis]);
        constexpr double kTie = 1e-6;  // of two slices as near to one the first is taken
        return slices.step >= 1 || (beside > -slices.step / 2 - kTie && beside <= slices.step / 2 - kTie);
    });
}

}  // namespace kontur::app
