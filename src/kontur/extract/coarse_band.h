// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/extract/tracker.h"

namespace kontur {

/// Of a coarse lattice's cells, in spacings of the grid; 3 and 5 need more values.
inline constexpr int kCoarseStride = 4;
/// Coarse cells without a change of sign are looked into when a corner is this close, in coarse spacings: the surface can
/// bulge through a face.
inline constexpr double kCoarseBulge = 0.25;

/// The coarse cell that an index of the grid (not rounded) lies in.
Index3 coarse_cell_at(const Vec3& index, const Index3& stride);

/// Every stride-th point of a grid along each axis, and cells between them. Coarse point (i, j, k) is the grid's point
/// (i * stride.i, ...); coarse cell (i, j, k) lies between that point and the next, faces included. Points go two cells
/// beyond the grid, so that every cell that holds points of the grid has neighbours to interpolate from.
class CoarseLattice {
public:
    CoarseLattice(const Grid& grid, const Index3& stride);

    const Grid& grid() const { return grid_; }
    const Index3& stride() const { return stride_; }

    /// NaN where not computed.
    double value(const Index3& point) const { return lattice_.value(shifted(point)); }
    void set_value(const Index3& point, double value) { lattice_.set_value(shifted(point), value); }
    Vec3 position_mm(const Index3& point) const {
        return grid_.center_mm(point.i * stride_.i, point.j * stride_.j, point.k * stride_.k);
    }
    bool is_in_grid(const Index3& point) const;
    /// Whether the cell holds points of the grid.
    bool is_cell(const Index3& cell) const;
    bool mark_cell(const Index3& cell) { return lattice_.mark_cell(shifted(cell)); }
    Index3 cell_at(const Vec3& index) const { return coarse_cell_at(index, stride_); }
    /// How many nodes interpolation takes along an axis: 4, or 2 where every point of the grid is a coarse one.
    std::int64_t stencil_nodes(int axis) const { return stride_[axis] > 1 ? 4 : 2; }

private:
    static constexpr std::int64_t kMargin = 2;
    static Index3 shifted(const Index3& p) { return {p.i + kMargin, p.j + kMargin, p.k + kMargin}; }

    Grid grid_;
    Index3 stride_;
    Lattice lattice_;
};

/// What of the cells is computed when the surface has been followed.
enum class CoarseValues {
    corners,   ///< what following it took
    stencils,  ///< and the values that interpolation in them needs
};

struct CoarseFloodOptions {
    double bulge_mm;      ///< a corner so close counts like a change of sign
    CoarseValues values;  ///< that are computed
};

struct CoarseCells {
    std::vector<Index3> cells;  ///< that the surface passes or may bulge into, in the order they were met
    std::int64_t evaluations;   ///< values computed
};

/// Follows the surface over the coarse cells from those that hold the starts. Points outside of the grid count as outside of
/// the object.
CoarseCells flood_coarse_cells(CoarseLattice& lattice, const EvaluatePoints& evaluate, std::span<const Index3> start_cells,
                               const CoarseFloodOptions& options, const Work& work);

}  // namespace kontur
