// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/image_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr double kMargin = 0.12;         // of the drawing's diagonal, to each side
constexpr std::size_t kScaled = 20'000;  // about how many cells tell the scale
constexpr double kMostSamples = 2;       // along each axis of a cell

/// Axes of unit length that turn with the image; sheared ones are set upright. The origin is the first voxel's centre.
Affine3 upright_frame(const Grid& grid) {
    const Affine3& to_mm = grid.index_to_mm;
    const Vec3 x = normalized(to_mm.column(0)), across = to_mm.column(1);
    const Vec3 y = normalized(across - dot(across, x) * x);
    const Vec3 z = cross(x, y);
    Affine3 frame;
    frame.set_column(0, x);
    frame.set_column(1, y);
    frame.set_column(2, dot(z, to_mm.column(2)) < 0 ? -z : z);
    frame.translation = to_mm.translation;
    return frame;
}

Box3 box_of(const ContourSet& contours, const Affine3& to_frame) {
    Box3 box;
    for (const Contour& contour : contours.contours)
        for (const Vec3& p : contour.points) box.extend(to_frame.apply(p));
    return box.padded(kMargin * box.diagonal());
}

/// Lattice points at multiples of the edge from the frame's origin.
Grid cubes(const Affine3& frame, const Box3& box, double edge_mm) {
    Grid grid;
    Vec3 first;
    for (int axis = 0; axis < 3; ++axis) {
        first[axis] = std::floor(box.min[axis] / edge_mm) * edge_mm;
        grid.size[axis] = static_cast<std::int64_t>(std::ceil((box.max[axis] - first[axis]) / edge_mm)) + 1;
        grid.index_to_mm.set_column(axis, edge_mm * frame.column(axis));
    }
    grid.index_to_mm.translation = frame.apply(first);
    return grid;
}

/// The mean over a cube of what the image shows in it.
float mean_in(const Intensities& image, const Affine3& to_mm, const Vec3& index, int samples) {
    double sum = 0;
    int count = 0;
    const auto place = [&](int n) { return (n + 0.5) / samples - 0.5; };
    for (int k = 0; k < samples; ++k)
        for (int j = 0; j < samples; ++j)
            for (int i = 0; i < samples; ++i) {
                const double value = image.at(to_mm.apply(index + Vec3{place(i), place(j), place(k)}));
                if (!std::isfinite(value)) continue;
                sum += value;
                ++count;
            }
    return count > 0 ? static_cast<float>(sum / count) : std::numeric_limits<float>::quiet_NaN();
}

void scale(std::vector<float>& looks) {
    std::vector<double> some;
    const std::size_t step = std::max<std::size_t>(1, looks.size() / kScaled);
    for (std::size_t n = 0; n < looks.size(); n += step) some.push_back(looks[n]);
    const IntensityScale to_unit(std::move(some));
    for (float& look : looks)
        if (std::isfinite(look)) look = static_cast<float>(to_unit(look));
}

}  // namespace

ImageCells image_cells(const Image& image, const ContourSet& contours, std::size_t most, const Work& work) {
    const Affine3 frame = upright_frame(image.grid);
    const Box3 box = box_of(contours, frame.inverse());
    const Vec3 size = box.size();
    const double edge =
        std::max(std::cbrt(image.grid.voxel_volume_mm3()), std::cbrt(size.x * size.y * size.z / static_cast<double>(most)));
    ImageCells cells{cubes(frame, box, edge)};
    const Intensities intensities(image);
    const int samples = static_cast<int>(std::clamp(std::round(edge / intensities.voxel_mm()), 1.0, kMostSamples));
    cells.looks.resize(static_cast<std::size_t>(cells.grid.voxel_count()));
    parallel_for(cells.grid.size.k, 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k)
            for (std::int64_t j = 0; j < cells.grid.size.j; ++j)
                for (std::int64_t i = 0; i < cells.grid.size.i; ++i)
                    cells.looks[cells.grid.offset(i, j, k)] =
                        mean_in(intensities, cells.grid.index_to_mm,
                                {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}, samples);
    });
    cells.intensities = cells.grid.voxel_count() * samples * samples * samples;
    scale(cells.looks);
    return cells;
}

}  // namespace kontur
