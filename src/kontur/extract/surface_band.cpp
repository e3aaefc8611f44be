// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/surface_band.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kontur/extract/coarse_band.h"
#include "kontur/extract/isolines.h"

namespace kontur {
namespace {

constexpr Index3 kStride{kCoarseStride, kCoarseStride, kCoarseStride};

/// Beyond the band nothing changes sides: along a row each unknown value is on the side of the one before.
void fill_unknown(const IsolineLattice& lattice, double magnitude, std::vector<double>& values) {
    for (std::size_t n = 0; n < values.size(); ++n) {
        if (!std::isnan(values[n])) continue;
        const bool begins_row = n % static_cast<std::size_t>(lattice.columns) == 0;
        values[n] = !begins_row && values[n - 1] > 0 ? magnitude : -magnitude;
    }
}

}  // namespace

SurfaceBand::SurfaceBand(const ImplicitFunction& function, std::span<const Vec3> starts, const PreviewOptions& options,
                         const Work& work)
    : function_(function), options_(options), threads_(work.threads) {
    const std::optional<Grid> grid = preview_lattice(starts, options.spacing_mm);
    if (!grid) return;
    size_ = grid->size;
    mm_to_index_ = grid->index_to_mm.inverse();
    CoarseLattice coarse(*grid, kStride);
    std::vector<Index3> start_cells;
    for (const Vec3& p : starts)
        if (is_finite(p)) start_cells.push_back(coarse.cell_at(mm_to_index_.apply(p)));
    const auto evaluate = [&](std::span<const Vec3> points, std::span<double> values) {
        function_.values(points, values, work);
    };
    const auto [cells, evaluations] = flood_coarse_cells(
        coarse, evaluate, start_cells, {kCoarseBulge * kCoarseStride * options.spacing_mm, CoarseValues::corners}, work);
    evaluations_ += evaluations;
    if (cells.empty()) return;

    first_cell_ = cells.front();
    Index3 last_cell = cells.front();
    for (const Index3& cell : cells)
        for (int axis = 0; axis < 3; ++axis) {
            first_cell_[axis] = std::min(first_cell_[axis], cell[axis]);
            last_cell[axis] = std::max(last_cell[axis], cell[axis]);
        }
    for (int axis = 0; axis < 3; ++axis) cells_along_[axis] = last_cell[axis] - first_cell_[axis] + 1;
    is_passed_.resize(static_cast<std::size_t>(cells_along_.i * cells_along_.j * cells_along_.k));
    for (const Index3& cell : cells) is_passed_[*place_of(cell)] = true;
    box_mm_.extend(coarse.position_mm(first_cell_));
    box_mm_.extend(coarse.position_mm({last_cell.i + 1, last_cell.j + 1, last_cell.k + 1}));
}

bool SurfaceBand::is_in_lattice(const Vec3& index) const {
    for (int axis = 0; axis < 3; ++axis)
        if (!(index[axis] >= 0 && index[axis] <= static_cast<double>(size_[axis] - 1))) return false;
    return true;
}

/// Of a coarse cell in `is_passed_`; nullopt outside of the box.
std::optional<std::size_t> SurfaceBand::place_of(const Index3& cell) const {
    Index3 at;
    for (int axis = 0; axis < 3; ++axis) {
        at[axis] = cell[axis] - first_cell_[axis];
        if (at[axis] < 0 || at[axis] >= cells_along_[axis]) return std::nullopt;
    }
    return static_cast<std::size_t>(at.i + cells_along_.i * (at.j + cells_along_.j * at.k));
}

bool SurfaceBand::contains(const Vec3& index) const {
    const std::optional<std::size_t> place = place_of(coarse_cell_at(index, kStride));
    return place && is_passed_[*place];
}

std::vector<std::vector<Vec3>> SurfaceBand::cut(const Plane& plane) const {
    if (box_mm_.is_empty()) return {};
    const std::optional<IsolineLattice> lattice = lattice_over(plane, corners(box_mm_), options_.spacing_mm);
    if (!lattice) return {};
    std::vector<double> values(static_cast<std::size_t>(lattice->node_count()), std::nan(""));
    std::vector<std::size_t> nodes;
    std::vector<Vec3> points;
    bool was_in_lattice = true;
    for (std::size_t n = 0; n < values.size(); ++n) {
        const auto node = static_cast<std::int64_t>(n);
        const auto [u, v] = lattice->uv(node % lattice->columns, node / lattice->columns);
        const Vec3 point = plane.from_uv(u, v);
        const Vec3 index = mm_to_index_.apply(point);
        const bool enters_lattice = !std::exchange(was_in_lattice, is_in_lattice(index));
        if (!was_in_lattice) {
            values[n] = -options_.spacing_mm;  // a leak is cut off there
        } else if (enters_lattice || contains(index)) {
            nodes.push_back(n);
            points.push_back(point);
        }
    }
    std::vector<double> values_at(points.size());
    function_.values(points, values_at, {.threads = threads_});
    for (std::size_t i = 0; i < nodes.size(); ++i) values[nodes[i]] = values_at[i];
    fill_unknown(*lattice, options_.spacing_mm, values);

    std::vector<std::vector<Vec3>> lines;
    for (const Isoline& isoline : isolines(*lattice, values)) {
        std::vector<Vec3>& line = lines.emplace_back();
        for (const auto& [u, v] : isoline.points) line.push_back(plane.from_uv(u, v));
    }
    return lines;
}

}  // namespace kontur
