// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "kontur/extract/track.h"

namespace kontur {

/// The lattice edges that a surface crosses, each with the area for which it stands on average (Crofton).
class EdgeCrossings {
public:
    explicit EdgeCrossings(const SurfaceLattice& surface) : surface_(surface), grid_(surface.lattice.grid()) {
        const double cell_mm3 = grid_.voxel_volume_mm3();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Vec3 edge = grid_.index_to_mm.column(static_cast<int>(axis));
            directions_[axis] = normalized(edge);
            measures_[axis] = cell_mm3 / norm(edge);
        }
    }

    /// Calls `visit(point_mm, measure)` for each, where the surface crosses it by linear interpolation: off by as much as f
    /// bends within a cell. Each edge is the cell's whose lowest corner it begins at. Edges that leave the grid are no
    /// surface of f.
    template <class Visit>
    void visit(const Visit& visit) const {
        for (const Index3& cell : surface_.cells) {
            const double here = surface_.lattice.value(cell);
            if (!std::isfinite(here)) continue;
            for (int axis = 0; axis < 3; ++axis) {
                Index3 next = cell;
                ++next[axis];
                const double there = surface_.lattice.value(next);
                if (!std::isfinite(there) || (here > 0) == (there > 0)) continue;
                Vec3 at{static_cast<double>(cell.i), static_cast<double>(cell.j), static_cast<double>(cell.k)};
                at[axis] += here / (here - there);
                visit(grid_.index_to_mm.apply(at), measures_[static_cast<std::size_t>(axis)]);
            }
        }
    }

    double step_mm() const { return 0.5 * norm(grid_.spacing_mm()); }

    /// Measure of the edges that a unit of area with this normal crosses.
    double density(const Vec3& normal) const {
        double sum = 0;
        for (const Vec3& direction : directions_) sum += std::abs(dot(normal, direction));
        return sum;
    }

private:
    const SurfaceLattice& surface_;
    const Grid& grid_;
    std::array<Vec3, 3> directions_;
    std::array<double, 3> measures_{};
};

}  // namespace kontur
