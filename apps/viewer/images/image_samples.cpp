// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/image_samples.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kontur::viewer {
namespace {

/// Samples along one direction of the screen, in its pixels.
struct Spread {
    double first = 0, step = 1;
    int count = 0;
};

/// The axis of the grid that a direction follows: along all of the raster it drifts off it by less than a hundredth of a
/// voxel.
std::optional<int> axis_along(const Vec3& index_per_pixel, int pixels) {
    constexpr double kDrift = 0.01;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = std::abs(index_per_pixel[(axis + 1) % 3]), b = std::abs(index_per_pixel[(axis + 2) % 3]);
        if (std::max(a, b) * pixels < kDrift) return axis;
    }
    return std::nullopt;
}

/// Every multiple of the step from `phase` on that the pixels need: one beyond them to both sides, from number `least` to
/// `most`.
Spread covering(int pixels, double phase, double step, double least, double most) {
    const double from = std::max(std::floor((-0.5 - phase) / step), least),
                 to = std::min(std::ceil((pixels - 0.5 - phase) / step), most);
    return {phase + from * step, step, static_cast<int>(std::max(to - from, 0.0)) + 1};
}

Spread along_axis(double index, double index_per_pixel, std::int64_t size, int pixels) {
    const double voxel = std::round(index), direction = index_per_pixel > 0 ? 1 : -1;
    const double last = static_cast<double>(size - 1);
    // Sample n is the voxel `voxel + direction * n`: those in the grid, or of a grid that lies beside them all its nearest.
    const double ends[] = {-voxel * direction, (last - voxel) * direction};
    return covering(pixels, (voxel - index) / index_per_pixel, 1 / std::abs(index_per_pixel), std::min(ends[0], ends[1]),
                    std::max(ends[0], ends[1]));
}

Spread spread(const Grid& grid, const Vec3& index, const Vec3& index_per_pixel, int pixels) {
    constexpr double kAcross = 0.5;
    const double most = std::max({std::abs(index_per_pixel.x), std::abs(index_per_pixel.y), std::abs(index_per_pixel.z)});
    const std::optional<int> axis = axis_along(index_per_pixel, pixels);
    const double step = (axis ? 1 : kAcross) / most;
    if (!(step > 1)) return {0, 1, pixels};
    if (axis) return along_axis(index[*axis], index_per_pixel[*axis], grid.size[*axis], pixels);
    constexpr double kAny = std::numeric_limits<double>::infinity();
    return covering(pixels, 0, step, -kAny, kAny);
}

}  // namespace

ImageSamples samples_for(const Grid& grid, const Reslice& screen) {
    const Affine3 mm_to_index = grid.index_to_mm.inverse();
    const Vec3 index = mm_to_index.apply(screen.plane.origin);
    const Spread columns = spread(grid, index, mm_to_index.apply_linear(screen.pixel_mm * screen.plane.u), screen.width);
    const Spread rows = spread(grid, index, mm_to_index.apply_linear(screen.pixel_mm * screen.plane.v), screen.height);
    ImageSamples samples{screen, {columns.first, rows.first}, {columns.step, rows.step}};
    samples.raster.plane.origin = screen.plane.from_uv(columns.first * screen.pixel_mm, rows.first * screen.pixel_mm);
    samples.raster.width = columns.count;
    samples.raster.height = rows.count;
    samples.raster.pixel_mm = columns.step * screen.pixel_mm;
    samples.raster.row_mm = rows.step * screen.pixel_mm;
    return samples;
}

}  // namespace kontur::viewer
