// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/rasterize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"

namespace kontur {
namespace {

/// A contour in index coordinates and the slice it lies on.
struct IndexedContour {
    std::vector<Vec3> points;
    double slice = 0;
};

IndexedContour to_index(const Contour& contour, const Affine3& mm_to_index, std::size_t number) {
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::invalid_input, fmt::format("contour {} {}", number, what));
    };
    if (contour.points.empty()) refuse("has no points");
    if (!contour.closed) refuse("is open; only closed contours enclose voxels");
    IndexedContour indexed;
    double sum = 0;
    for (const Vec3& p : contour.points) {
        if (!is_finite(p)) refuse("has a NaN or infinite coordinate");
        indexed.points.push_back(mm_to_index.apply(p));
        sum += indexed.points.back().z;
    }
    indexed.slice = std::round(sum / static_cast<double>(contour.points.size()));
    for (const Vec3& p : indexed.points)
        if (!(std::abs(p.z - indexed.slice) <= 0.5))
            refuse(fmt::format(
                "is not drawn on a slice of the grid: a point lies {:.3g} slices off slice {:.0f}; the limit is 0.5",
                std::abs(p.z - indexed.slice), indexed.slice));
    return indexed;
}

/// First index not below `x`, within [0, size].
std::int64_t first_index(double x, std::int64_t size) {
    return static_cast<std::int64_t>(std::clamp(std::ceil(x), 0.0, static_cast<double>(size)));
}

/// Flips, in each row between the edge's ends (the lower one included), the first voxel centre not left of the edge. The
/// ends are ordered first, so that an edge drawn in both directions crosses at the same bits and cancels.
void flip_along_edge(Vec3 a, Vec3 b, std::int64_t k, Mask& mask) {
    if (b.y < a.y) std::swap(a, b);
    const std::int64_t end = first_index(b.y, mask.grid.size.j);
    for (std::int64_t j = first_index(a.y, mask.grid.size.j); j < end; ++j) {
        const double x = a.x + (b.x - a.x) * ((static_cast<double>(j) - a.y) / (b.y - a.y));
        const std::int64_t i = first_index(x, mask.grid.size.i);
        if (i < mask.grid.size.i) mask.values[mask.grid.offset(i, j, k)] ^= 1;
    }
}

/// Turns flips into insides: each voxel takes the parity of the flips up to it in its row.
void accumulate_rows(Mask& mask) {
    const auto row = static_cast<std::size_t>(mask.grid.size.i);
    for (std::size_t start = 0; start < mask.values.size(); start += row)
        for (std::size_t n = start + 1; n < start + row; ++n) mask.values[n] ^= mask.values[n - 1];
}

}  // namespace

Mask rasterize(const ContourSet& contours, const Grid& grid) {
    check_grid(grid);
    const Affine3 mm_to_index = grid.index_to_mm.inverse();
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()), 0)};
    for (std::size_t n = 0; n < contours.contours.size(); ++n) {
        const IndexedContour contour = to_index(contours.contours[n], mm_to_index, n + 1);
        if (contour.slice < 0 || contour.slice >= static_cast<double>(grid.size.k)) continue;
        const auto k = static_cast<std::int64_t>(contour.slice);
        for (std::size_t p = 0; p < contour.points.size(); ++p)
            flip_along_edge(contour.points[p], contour.points[(p + 1) % contour.points.size()], k, mask);
    }
    accumulate_rows(mask);
    return mask;
}

FilledSlices filled_slices(const Mask& mask) {
    const Index3& size = mask.grid.size;
    const auto slice = static_cast<std::size_t>(size.i * size.j);
    FilledSlices found;
    std::int64_t first = 0, last = -1;
    for (std::int64_t k = 0; k < size.k; ++k) {
        const auto* voxels = mask.values.data() + static_cast<std::size_t>(k) * slice;
        if (std::find_if(voxels, voxels + slice, [](std::uint8_t v) { return v != 0; }) == voxels + slice) continue;
        if (found.filled++ == 0) first = k;
        last = k;
    }
    found.extent = last - first + 1;
    return found;
}

}  // namespace kontur
