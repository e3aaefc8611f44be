// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/existing_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kontur/base/parallel.h"
#include "kontur/extract/cell_triangles.h"

namespace kontur {
namespace {

/// Of four voxels that differ in j (bit 0) and k (bit 1).
template <class Value>
unsigned inside_of(const std::array<const Value*, 4>& rows, std::int64_t i) {
    unsigned bits = 0;
    for (unsigned n = 0; n < 4; ++n) bits |= static_cast<unsigned>(rows[n][i] > 0) << n;
    return bits;
}

/// Room for the bits of the voxels beside them along i.
unsigned spread(unsigned bits) { return (bits & 1) | (bits & 2) << 1 | (bits & 4) << 2 | (bits & 8) << 3; }

/// Calls `visit(i, inside)` for each cell of a row that has corners on both sides. `rows`: of `count` voxels each.
template <class Value, class Visit>
void for_each_cut_cell(const std::array<const Value*, 4>& rows, std::int64_t count, const Visit& visit) {
    unsigned low = inside_of(rows, 0);
    for (std::int64_t i = 0; i + 1 < count; ++i) {
        const unsigned high = inside_of(rows, i + 1), inside = spread(low) | spread(high) << 1;
        if (inside != 0 && inside != 255) visit(i, inside);
        low = high;
    }
}

/// Who counts where two voxels beside a point were changed.
int rank(CorrectedVoxel how) {
    switch (how) {
        case CorrectedVoxel::added_drawn:
        case CorrectedVoxel::removed_drawn:
            return 3;
        case CorrectedVoxel::added_image:
        case CorrectedVoxel::removed_image:
            return 2;
        case CorrectedVoxel::added_carried:
        case CorrectedVoxel::removed_carried:
            return 1;
        default:
            return 0;
    }
}

/// The box of all cells that the surface may cut.
IndexBox cell_box(const ExistingSurface& surface, std::span<const MadeVoxel> voxels) {
    IndexBox box = surface.window_box();
    for (const MadeVoxel& voxel : voxels) {
        const Index3 at = index_at(voxel.offset, surface.grid().size);
        box = box_around(box, {{at.i - 1, at.j - 1, at.k - 1}, {at.i + 1, at.j + 1, at.k + 1}});
    }
    return box;
}

}  // namespace

ExistingMesh::ExistingMesh(const ExistingSurface& surface, const Work& work)
    : surface_(surface), values_(unshrunk_values(surface, work)) {
    find_cells();
}

void ExistingMesh::find_cells() {
    const Grid& window = surface_.window();
    const Index3& size = window.size;
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j) {
            row_start_.push_back(cells_.size());
            if (j + 1 == size.j || k + 1 == size.k) continue;
            const float* row = values_.data() + window.offset(0, j, k);
            const std::array rows{row, row + size.i, row + size.i * size.j, row + size.i * size.j + size.i};
            for_each_cut_cell(rows, size.i, [&](std::int64_t i, unsigned inside) {
                cells_.push_back({static_cast<std::int32_t>(i), static_cast<std::uint8_t>(inside)});
            });
        }
    row_start_.push_back(cells_.size());
}

/// One mesh. Voxels and cells have the mask's indices, which may lie beyond its grid.
class CorrectedMeshBuilder {
public:
    CorrectedMeshBuilder(const ExistingMesh& existing, const ChangeLattice* change, std::span<const MadeVoxel> voxels,
                         const Work& work)
        : existing_(existing),
          grid_(existing.surface_.grid()),
          window_(existing.surface_.window_box()),
          box_(cell_box(existing.surface_, voxels)),
          voxels_(voxels),
          change_(change),
          work_(work),
          to_index_(grid_.index_to_mm.inverse()),
          is_mirrored_(grid_.index_to_mm.determinant() < 0),
          least_(least_value(existing.surface_)) {
        const Index3 size = box_.size();
        for (Slice& slice : slices_) {
            slice.points.resize(static_cast<std::size_t>(3 * size.i * size.j));
            slice.sides.resize(static_cast<std::size_t>(size.i * size.j));
            slice.known_for.assign(static_cast<std::size_t>(size.j), box_.low.k - 1);
        }
        find_rows();
    }

    CorrectedMesh build() {
        for (std::int64_t k = box_.low.k; k < box_.high.k; ++k) {
            work_.check();
            slice_of(k + 1).earlier_points = edges_.size();
            for (std::int64_t j = box_.low.j; j < box_.high.j; ++j) add_row(j, k);
        }
        place_points();
        return std::move(made_);
    }

private:
    using Cell = ExistingMesh::Cell;

    /// The line from a voxel to the next one along an axis.
    struct Edge {
        Index3 from;
        int axis;
    };

    std::size_t row_of(std::int64_t j, std::int64_t k) const {
        return static_cast<std::size_t>(j - box_.low.j + box_.size().j * (k - box_.low.k));
    }

    /// Where the changed voxels of each row begin.
    void find_rows() {
        const auto rows = static_cast<std::size_t>(box_.size().j * box_.size().k);
        row_start_.assign(rows + 1, 0);
        for (const MadeVoxel& voxel : voxels_) {
            const Index3 at = index_at(voxel.offset, grid_.size);
            ++row_start_[row_of(at.j, at.k) + 1];
        }
        for (std::size_t row = 0; row < rows; ++row) row_start_[row + 1] += row_start_[row];
    }

    std::span<const MadeVoxel> changed_in(std::int64_t j, std::int64_t k) const {
        const std::size_t row = row_of(j, k);
        return voxels_.subspan(row_start_[row], row_start_[row + 1] - row_start_[row]);
    }

    const MadeVoxel* changed_at(const Index3& v) const {
        const std::span<const MadeVoxel> row = changed_in(v.j, v.k);
        if (row.empty() || v.i < 0 || v.i >= grid_.size.i) return nullptr;
        const auto found = std::ranges::lower_bound(row, grid_.offset(v.i, v.j, v.k), {}, &MadeVoxel::offset);
        return found != row.end() && found->offset == grid_.offset(v.i, v.j, v.k) ? &*found : nullptr;
    }

    float value_before(const Index3& v) const {
        if (!window_.contains(v)) return std::min(static_cast<float>(existing_.surface_.value_at_voxel(v)), -least_);
        const Index3& low = window_.low;
        return existing_.values_[existing_.surface_.window().offset(v.i - low.i, v.j - low.j, v.k - low.k)];
    }

    float value(const Index3& v) const {
        const float before = value_before(v);
        const MadeVoxel* changed = changed_at(v);
        const bool inside = changed ? changed->is_inside() : before > 0;
        float after = before;
        if (change_ && change_->box().contains(v) && std::abs(static_cast<double>(before)) <= change_->near_mm())
            after += static_cast<float>(change_->at(v));
        return inside ? std::max(after, least_) : std::min(after, -least_);
    }

    std::span<const Cell> cells_before(std::int64_t j, std::int64_t k) const {
        if (j < window_.low.j || j > window_.high.j || k < window_.low.k || k > window_.high.k) return {};
        const std::int64_t row = j - window_.low.j + window_.size().j * (k - window_.low.k);
        const std::size_t first = existing_.row_start_[static_cast<std::size_t>(row)];
        return std::span(existing_.cells_).subspan(first, existing_.row_start_[static_cast<std::size_t>(row) + 1] - first);
    }

    void add_row(std::int64_t j, std::int64_t k) {
        const std::array rows{changed_in(j, k), changed_in(j + 1, k), changed_in(j, k + 1), changed_in(j + 1, k + 1)};
        if (std::ranges::all_of(rows, [](const auto& row) { return row.empty(); })) {
            for (const Cell& cell : cells_before(j, k)) add_cell({cell.i + window_.low.i, j, k}, cell.inside);
            return;
        }
        for_each_cut_cell(std::array{sides_of(j, k), sides_of(j + 1, k), sides_of(j, k + 1), sides_of(j + 1, k + 1)},
                          box_.size().i, [&](std::int64_t i, unsigned inside) {
                              add_cell({i + box_.low.i, j, k}, inside);
                          });
    }

    /// Whether the voxels of a row of the box are inside, found once for the layers on both sides of it.
    const std::uint8_t* sides_of(std::int64_t j, std::int64_t k) {
        Slice& slice = slice_of(k);
        const std::int64_t size = box_.size().i, row = j - box_.low.j;
        std::uint8_t* sides = slice.sides.data() + row * size;
        if (std::exchange(slice.known_for[static_cast<std::size_t>(row)], k) == k) return sides;
        for (std::int64_t i = 0; i < size; ++i) sides[i] = value_before({i + box_.low.i, j, k}) > 0;
        for (const MadeVoxel& voxel : changed_in(j, k))
            sides[index_at(voxel.offset, grid_.size).i - box_.low.i] = voxel.is_inside();
        return sides;
    }

    void add_cell(const Index3& cell, unsigned inside) {
        for (const CellTriangle& t : cell_triangles(inside)) {
            std::array<std::uint32_t, 3> triangle{point_on(cell, t[0]), point_on(cell, t[1]), point_on(cell, t[2])};
            if (is_mirrored_) std::swap(triangle[1], triangle[2]);
            made_.mesh.triangles.push_back(triangle);
        }
    }

    std::uint32_t point_on(const Index3& cell, int edge_number) {
        const CellEdge& edge = cell_edges()[static_cast<std::size_t>(edge_number)];
        const Index3 from{cell.i + (edge.from & 1), cell.j + (edge.from >> 1 & 1), cell.k + (edge.from >> 2 & 1)};
        Slice& slice = slice_of(from.k);
        const std::int64_t in_slice = from.i - box_.low.i + box_.size().i * (from.j - box_.low.j);
        std::uint32_t& known = slice.points[static_cast<std::size_t>(3 * in_slice + edge.axis)];
        if (known <= slice.earlier_points) {
            edges_.push_back({from, edge.axis});
            known = static_cast<std::uint32_t>(edges_.size());
        }
        return known - 1;
    }

    void place_points() {
        TriangleMesh& mesh = made_.mesh;
        mesh.points.resize(edges_.size());
        mesh.normals.resize(edges_.size());
        made_.made_by.resize(edges_.size());
        parallel_for(static_cast<std::int64_t>(edges_.size()), 1 << 12, work_, [&](std::int64_t begin, std::int64_t end) {
            for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) place(n);
        });
    }

    void place(std::size_t n) {
        const auto& [from, axis] = edges_[n];
        Index3 to = from;
        ++to[axis];
        const double low = value(from), high = value(to), part = low / (low - high);
        Vec3 index{static_cast<double>(from.i), static_cast<double>(from.j), static_cast<double>(from.k)};
        index[axis] += part;
        made_.mesh.points[n] = grid_.index_to_mm.apply(index);
        const Vec3 slope = (1 - part) * slope_at(from) + part * slope_at(to);
        Vec3 gradient;
        for (std::size_t row = 0; row < 3; ++row) {
            const std::array<double, 3>& linear = to_index_.linear[row];
            gradient += slope[static_cast<int>(row)] * Vec3{linear[0], linear[1], linear[2]};
        }
        made_.mesh.normals[n] = -normalized(gradient);
        made_.made_by[n] = CorrectedVoxel::inside;
        for (const Index3& v : {from, to})
            if (const MadeVoxel* changed = changed_at(v); changed && rank(changed->how) > rank(made_.made_by[n]))
                made_.made_by[n] = changed->how;
    }

    /// By differences.
    Vec3 slope_at(const Index3& at) const {
        Vec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
            Index3 low = at, high = at;
            low[axis] = std::max(low[axis] - 1, box_.low[axis]);
            high[axis] = std::min(high[axis] + 1, box_.high[axis]);
            slope[axis] = (static_cast<double>(value(high)) - value(low)) / static_cast<double>(high[axis] - low[axis]);
        }
        return slope;
    }

    /// Of the edges that begin at the voxels of a slice, by voxel and axis: one more than the number of their points.
    /// Numbers up to those that were there before the slice's first layer are of another slice.
    struct Slice {
        std::vector<std::uint32_t> points;
        std::size_t earlier_points = 0;
        std::vector<std::uint8_t> sides;      ///< sides_of the rows that
        std::vector<std::int64_t> known_for;  ///< ... were found in this slice
    };
    Slice& slice_of(std::int64_t k) { return slices_[static_cast<std::size_t>(k & 1)]; }

    const ExistingMesh& existing_;
    const Grid& grid_;
    IndexBox window_, box_;
    std::span<const MadeVoxel> voxels_;
    const ChangeLattice* change_;
    const Work& work_;
    Affine3 to_index_;
    bool is_mirrored_;
    float least_;
    std::vector<std::size_t> row_start_;  ///< in `voxels_`, by row of the box
    std::array<Slice, 2> slices_;
    std::vector<Edge> edges_;  ///< one for each point
    CorrectedMesh made_;
};

CorrectedMesh ExistingMesh::corrected(const ChangeLattice* change, std::span<const MadeVoxel> voxels,
                                      const Work& work) const {
    return CorrectedMeshBuilder(*this, change, voxels, work).build();
}

}  // namespace kontur
