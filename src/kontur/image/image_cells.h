// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/image/intensities.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// The image around a drawing, by cubes: a lattice that turns and moves with the image, whatever its voxels' sides are.
struct ImageCells {
    Grid grid;                     ///< of cubes; of the image's voxels where these are cubes and not too many
    std::vector<float> looks{};    ///< of each cube, from 0 to 1 (IntensityScale); NaN where the image shows nothing
    std::int64_t intensities = 0;  ///< read from the image

    double edge_mm() const { return norm(grid.index_to_mm.column(0)); }
    /// From a cube's centre to three of its faces.
    std::array<Vec3, 3> half_edges() const {
        const Affine3& to_mm = grid.index_to_mm;
        return {0.5 * to_mm.column(0), 0.5 * to_mm.column(1), 0.5 * to_mm.column(2)};
    }
    Index3 index(std::size_t cell) const { return index_at(cell, grid.size); }
    std::size_t offset(const Index3& at) const { return grid.offset(at.i, at.j, at.k); }
    bool holds(const Index3& at) const {
        return at.i >= 0 && at.j >= 0 && at.k >= 0 && at.i < grid.size.i && at.j < grid.size.j && at.k < grid.size.k;
    }
    Vec3 center(const Index3& at) const { return grid.center_mm(at.i, at.j, at.k); }
    Vec3 center(std::size_t cell) const { return center(index(cell)); }

    /// Calls visit(side, cell) for the up to six cells that share a face; sides are 0 to 5: back and forth along i, j, k.
    template <class Visit>
    void visit_neighbours(std::size_t cell, const Visit& visit) const {
        const Index3 at = index(cell);
        const std::array<std::int64_t, 3> strides{1, grid.size.i, grid.size.i * grid.size.j};
        for (int axis = 0; axis < 3; ++axis) {
            const auto stride = static_cast<std::size_t>(strides[static_cast<std::size_t>(axis)]);
            if (at[axis] > 0) visit(2 * axis, cell - stride);
            if (at[axis] + 1 < grid.size[axis]) visit(2 * axis + 1, cell + stride);
        }
    }
};

/// The whole numbers nearest to an index.
inline Index3 nearest_index(const Vec3& index) {
    return {std::llround(index.x), std::llround(index.y), std::llround(index.z)};
}

/// Cubes of an image voxel's volume, larger where they would be more than `most`, around the contours and so much beyond as
/// the surface between them may reach.
ImageCells image_cells(const Image& image, const ContourSet& contours, std::size_t most, const Work& work = {});

}  // namespace kontur
