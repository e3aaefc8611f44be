// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/coarse_band.h"

#include <algorithm>

namespace kontur {
namespace {

// Stands in the lattice for a value that is being computed, so that it is asked for only once.
constexpr double kPending = std::numeric_limits<double>::infinity();

std::int64_t last_cell(std::int64_t size, std::int64_t stride) { return (size - 1) / stride; }

Grid coarsened(const Grid& grid, const Index3& stride, std::int64_t margin) {
    Grid coarse;
    for (int axis = 0; axis < 3; ++axis) {
        coarse.size[axis] = last_cell(grid.size[axis], stride[axis]) + 1 + 2 * margin;
        coarse.index_to_mm.set_column(axis, static_cast<double>(stride[axis]) * grid.index_to_mm.column(axis));
    }
    coarse.index_to_mm.translation = grid.center_mm(-margin * stride.i, -margin * stride.j, -margin * stride.k);
    return coarse;
}

class Flood {
public:
    Flood(CoarseLattice& lattice, const EvaluatePoints& evaluate, double bulge_mm)
        : lattice_(lattice), evaluate_(evaluate), bulge_mm_(bulge_mm) {}

    void add_starts(std::span<const Index3> cells) {
        for (const Index3& c : cells)
            if (lattice_.is_cell(c) && lattice_.mark_cell(c)) front_.push_back(c);
    }

    bool is_done() const { return front_.empty(); }

    /// Visits the front; its cells stay in the band whatever their corners say if `are_starts`.
    void step(bool are_starts) {
        for (const Index3& cell : front_) want_box(cell, 0, 1);
        evaluate_wanted();
        std::vector<Index3> next;
        for (const Index3& cell : front_) visit(cell, are_starts, next);
        front_ = std::move(next);
    }

    void compute_stencils() {
        for (const Index3& cell : cells_) want_stencil(cell);
        evaluate_wanted();
    }

    std::vector<Index3> take_cells() { return std::move(cells_); }

    std::int64_t evaluations() const { return evaluations_; }

private:
    void visit(const Index3& cell, bool is_start, std::vector<Index3>& next) {
        std::array<double, 8> values;
        for (int n = 0; n < 8; ++n) values[static_cast<std::size_t>(n)] = sign_value(Lattice::corner(cell, n));
        const unsigned inside = inside_corners(values);
        const bool is_mixed = inside != 0 && inside != 0xffu;
        const auto is_close = [&](double v) { return std::abs(v) < bulge_mm_; };
        if (!is_mixed && !is_start && !std::any_of(values.begin(), values.end(), is_close)) return;
        cells_.push_back(cell);
        if (!is_mixed && !is_start) return;
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) {
                int inside_count = 0;
                bool close = false;
                for (int n = 0; n < 8; ++n) {
                    if ((n >> axis & 1) != side) continue;
                    inside_count += static_cast<int>(inside >> n & 1u);
                    close = close || is_close(values[static_cast<std::size_t>(n)]);
                }
                if ((inside_count == 0 || inside_count == 4) && !close) continue;
                Index3 neighbour = cell;
                neighbour[axis] += side ? 1 : -1;
                if (lattice_.is_cell(neighbour) && lattice_.mark_cell(neighbour)) next.push_back(neighbour);
            }
    }

    double sign_value(const Index3& point) const {
        return lattice_.is_in_grid(point) ? lattice_.value(point) : Lattice::kOutside;
    }

    void want_box(const Index3& low, std::int64_t from, std::int64_t to) {
        for (std::int64_t k = from; k <= to; ++k)
            for (std::int64_t j = from; j <= to; ++j)
                for (std::int64_t i = from; i <= to; ++i) want({low.i + i, low.j + j, low.k + k});
    }

    void want_stencil(const Index3& cell) {
        const auto range = [&](int axis) {
            return lattice_.stencil_nodes(axis) == 4 ? std::pair<std::int64_t, std::int64_t>{-1, 2}
                                                     : std::pair<std::int64_t, std::int64_t>{0, 1};
        };
        for (std::int64_t k = range(2).first; k <= range(2).second; ++k)
            for (std::int64_t j = range(1).first; j <= range(1).second; ++j)
                for (std::int64_t i = range(0).first; i <= range(0).second; ++i) want({cell.i + i, cell.j + j, cell.k + k});
    }

    void want(const Index3& point) {
        if (!std::isnan(lattice_.value(point))) return;
        lattice_.set_value(point, kPending);
        queue_.push_back(point);
    }

    void evaluate_wanted() {
        std::vector<Vec3> points;
        points.reserve(queue_.size());
        for (const Index3& p : queue_) points.push_back(lattice_.position_mm(p));
        std::vector<double> values(points.size());
        evaluate_(points, values);
        for (std::size_t i = 0; i < queue_.size(); ++i) lattice_.set_value(queue_[i], values[i]);
        evaluations_ += static_cast<std::int64_t>(queue_.size());
        queue_.clear();
    }

    CoarseLattice& lattice_;
    const EvaluatePoints& evaluate_;
    double bulge_mm_;
    std::vector<Index3> front_, cells_, queue_;
    std::int64_t evaluations_ = 0;
};

}  // namespace

CoarseLattice::CoarseLattice(const Grid& grid, const Index3& stride)
    : grid_(grid), stride_(stride), lattice_(coarsened(grid, stride, kMargin)) {}

bool CoarseLattice::is_in_grid(const Index3& point) const {
    for (int axis = 0; axis < 3; ++axis)
        if (point[axis] < 0 || point[axis] * stride_[axis] >= grid_.size[axis]) return false;
    return true;
}

bool CoarseLattice::is_cell(const Index3& cell) const {
    for (int axis = 0; axis < 3; ++axis)
        if (cell[axis] < -1 || cell[axis] > last_cell(grid_.size[axis], stride_[axis])) return false;
    return true;
}

Index3 coarse_cell_at(const Vec3& index, const Index3& stride) {
    Index3 cell;
    for (int axis = 0; axis < 3; ++axis)
        cell[axis] = static_cast<std::int64_t>(std::floor(index[axis] / static_cast<double>(stride[axis])));
    return cell;
}

CoarseCells flood_coarse_cells(CoarseLattice& lattice, const EvaluatePoints& evaluate, std::span<const Index3> start_cells,
                               const CoarseFloodOptions& options, const Work& work) {
    Flood flood(lattice, evaluate, options.bulge_mm);
    flood.add_starts(start_cells);
    for (bool are_starts = true; !flood.is_done(); are_starts = false) {
        work.check();
        flood.step(are_starts);
    }
    if (options.values == CoarseValues::stencils) flood.compute_stencils();
    std::vector<Index3> cells = flood.take_cells();
    return {std::move(cells), flood.evaluations()};
}

}  // namespace kontur
