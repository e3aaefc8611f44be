// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/section_contours.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "kontur/extract/isolines.h"

namespace kontur {
namespace {

/// What a voxel beside the outline keeps at least of its side, so that smoothing moves no centre to the other one.
constexpr double kLeastLevel = 0.05;

/// Above a half, so that voxels of a thin part that touch at a corner are one.
constexpr double kThinLevel = 0.55;

/// A slice as a lattice of voxel centres. Its axes are the grid's steps, so that (u, v) are voxel indices.
IsolineLattice lattice_of(const Grid& grid, const PaintedSlice& slice) {
    const auto [a, b] = slice_axes(slice.axis);
    const Vec3 u = grid.index_to_mm.column(a), v = grid.index_to_mm.column(b);
    Index3 origin;
    origin[slice.axis] = slice.index;
    IsolineLattice lattice;
    lattice.plane = {grid.center_mm(origin.i, origin.j, origin.k), normalized(cross(u, v)), u, v};
    lattice.columns = grid.size[a];
    lattice.rows = grid.size[b];
    return lattice;
}

Plane orthonormal(Plane plane) {
    plane.u = normalized(plane.u);
    plane.v = cross(plane.normal, plane.u);
    return plane;
}

std::vector<double> gaussian(double sigma) {
    const auto radius = static_cast<std::ptrdiff_t>(std::ceil(3 * sigma));
    std::vector<double> weights;
    double sum = 0;
    for (std::ptrdiff_t n = -radius; n <= radius; ++n) {
        const double x = static_cast<double>(n) / sigma;
        weights.push_back(std::exp(-x * x / 2));
        sum += weights.back();
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Averages along rows (stride 1) or columns. Beyond the lattice the outermost value goes on.
std::vector<double> smoothed(const std::vector<double>& values, std::int64_t count, std::int64_t stride,
                             const std::vector<double>& weights) {
    const auto radius = static_cast<std::int64_t>(weights.size() / 2);
    std::vector<double> result(values.size());
    for (std::int64_t n = 0; n < static_cast<std::int64_t>(values.size()); ++n) {
        const std::int64_t at = n / stride % count;
        double sum = 0;
        for (std::int64_t m = -radius; m <= radius; ++m) {
            const std::int64_t other = std::clamp<std::int64_t>(at + m, 0, count - 1);
            sum +=
                weights[static_cast<std::size_t>(m + radius)] * values[static_cast<std::size_t>(n + (other - at) * stride)];
        }
        result[static_cast<std::size_t>(n)] = sum;
    }
    return result;
}

/// The parts, painted or not, of which no voxel has all four neighbours in it: at most two voxels wide.
std::vector<std::uint8_t> thin_parts(const std::vector<std::uint8_t>& section, const IsolineLattice& lattice) {
    std::vector<std::uint8_t> thin(section.size(), 1);
    std::vector<std::size_t> front;
    const auto for_neighbours = [&](std::size_t n, std::int64_t corners, const auto& visit) {
        const std::int64_t a = static_cast<std::int64_t>(n) % lattice.columns,
                           b = static_cast<std::int64_t>(n) / lattice.columns;
        for (std::int64_t v = std::max<std::int64_t>(b - 1, 0); v <= std::min(b + 1, lattice.rows - 1); ++v)
            for (std::int64_t u = std::max<std::int64_t>(a - 1, 0); u <= std::min(a + 1, lattice.columns - 1); ++u)
                if (std::abs(u - a) + std::abs(v - b) <= 1 + corners)
                    visit(static_cast<std::size_t>(u + lattice.columns * v));
    };
    for (std::size_t n = 0; n < section.size(); ++n) {
        bool is_core = true;
        for_neighbours(n, 0, [&](std::size_t other) { is_core = is_core && section[other] == section[n]; });
        if (is_core) thin[n] = 0, front.push_back(n);
    }
    for (std::size_t next = 0; next < front.size(); ++next)
        for_neighbours(front[next], 1, [&](std::size_t other) {
            if (thin[other] && section[other] == section[front[next]]) thin[other] = 0, front.push_back(other);
        });
    return thin;
}

/// Above 0 where the section is. Of a single voxel smoothing leaves hardly a point, of a line a thread, at which a fit knows
/// no inside any more: thin parts are not smoothed.
std::vector<double> levels_of(const PaintedSlice& slice, const IsolineLattice& lattice, double sigma) {
    const std::vector<std::uint8_t> thin = thin_parts(slice.section, lattice);
    std::vector<double> levels(slice.section.size());
    for (std::size_t n = 0; n < levels.size(); ++n) levels[n] = (slice.section[n] != 0) != (thin[n] != 0) ? 1 : 0;
    if (sigma > 0) {
        const std::vector<double> weights = gaussian(sigma);
        levels = smoothed(levels, lattice.columns, 1, weights);
        levels = smoothed(levels, lattice.rows, lattice.columns, weights);
    }
    for (std::size_t n = 0; n < levels.size(); ++n) {
        const double least = thin[n] ? kThinLevel : kLeastLevel;
        levels[n] -= 0.5;
        levels[n] = slice.section[n] ? std::max(levels[n], least) : std::min(levels[n], -least);
    }
    return levels;
}

}  // namespace

std::vector<Contour> section_contours(const Grid& grid, const PaintedSlice& slice, const SectionContourOptions& options) {
    const IsolineLattice lattice = lattice_of(grid, slice);
    const Plane plane = orthonormal(lattice.plane);
    ContourSet set;
    for (const Isoline& line : isolines(lattice, levels_of(slice, lattice, options.smoothing_voxels))) {
        Contour& contour = set.contours.emplace_back(Contour{.plane = plane, .points = {}, .hole = line.hole});
        for (const auto& [u, v] : line.points) contour.points.push_back(lattice.plane.from_uv(u, v));
    }
    drop_duplicate_points(set);
    return std::move(set.contours);
}

ContourSet slice_outlines(const Mask& mask, const SectionContourOptions& options) {
    ContourSet set;
    const auto area = static_cast<std::ptrdiff_t>(mask.grid.size.i * mask.grid.size.j);
    for (std::int64_t k = 0; k < mask.grid.size.k; ++k) {
        const auto first = mask.values.begin() + static_cast<std::ptrdiff_t>(mask.grid.offset(0, 0, k));
        const PaintedSlice slice{.axis = 2, .index = k, .whole = true, .section = {first, first + area}};
        std::vector<Contour> contours = section_contours(mask.grid, slice, options);
        std::move(contours.begin(), contours.end(), std::back_inserter(set.contours));
    }
    return set;
}

}  // namespace kontur
