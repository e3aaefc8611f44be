// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/existing_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "kontur/base/parallel.h"
#include "kontur/correct/change_lattice.h"
#include "kontur/extract/cell_triangles.h"

namespace kontur {
namespace {

class MeshBuilder {
public:
    /// `values` at the voxels of a grid.
    MeshBuilder(const Grid& grid, std::vector<float> values)
        : grid_(grid),
          values_(std::move(values)),
          to_index_(grid_.index_to_mm.inverse()),
          is_mirrored_(grid_.index_to_mm.determinant() < 0) {
        for (Slice& slice : slices_) slice.points.resize(static_cast<std::size_t>(3 * grid.size.i * grid.size.j));
    }

    /// The cells between slices k and k + 1; layers come in order.
    void add_layer(std::int64_t k) {
        const Index3& size = grid_.size;
        slice_of(k + 1).earlier_points = mesh_.points.size();
        for (std::int64_t j = 0; j + 1 < size.j; ++j) {
            const float* row = values_.data() + grid_.offset(0, j, k);
            const std::array rows{row, row + size.i, row + size.i * size.j, row + size.i * size.j + size.i};
            unsigned low = inside_of(rows, 0);
            for (std::int64_t i = 0; i + 1 < size.i; ++i) {
                const unsigned high = inside_of(rows, i + 1), inside = spread(low) | spread(high) << 1;
                if (inside != 0 && inside != 255) add_cell({i, j, k}, inside);
                low = high;
            }
        }
    }

    TriangleMesh finish() { return std::move(mesh_); }

private:
    /// Of four voxels that differ in j (bit 0) and k (bit 1).
    static unsigned inside_of(const std::array<const float*, 4>& rows, std::int64_t i) {
        unsigned bits = 0;
        for (unsigned n = 0; n < 4; ++n) bits |= static_cast<unsigned>(rows[n][i] > 0) << n;
        return bits;
    }
    /// Room for the bits of the voxels beside them along i.
    static unsigned spread(unsigned bits) { return (bits & 1) | (bits & 2) << 1 | (bits & 4) << 2 | (bits & 8) << 3; }

    void add_cell(const Index3& cell, unsigned inside) {
        for (const CellTriangle& t : cell_triangles(inside)) {
            std::array<std::uint32_t, 3> triangle{point_on(cell, t[0]), point_on(cell, t[1]), point_on(cell, t[2])};
            if (is_mirrored_) std::swap(triangle[1], triangle[2]);
            mesh_.triangles.push_back(triangle);
        }
    }

    std::uint32_t point_on(const Index3& cell, int edge_number) {
        const CellEdge& edge = cell_edges()[static_cast<std::size_t>(edge_number)];
        const Index3 from{cell.i + (edge.from & 1), cell.j + (edge.from >> 1 & 1), cell.k + (edge.from >> 2 & 1)};
        Slice& slice = slice_of(from.k);
        std::uint32_t& known = slice.points[static_cast<std::size_t>(3 * (from.i + grid_.size.i * from.j) + edge.axis)];
        if (known <= slice.earlier_points) {
            add_point(from, edge.axis);
            known = static_cast<std::uint32_t>(mesh_.points.size());
        }
        return known - 1;
    }

    void add_point(const Index3& from, int axis) {
        Index3 to = from;
        ++to[axis];
        const double low = value(from), high = value(to), part = low / (low - high);
        Vec3 index{static_cast<double>(from.i), static_cast<double>(from.j), static_cast<double>(from.k)};
        index[axis] += part;
        mesh_.points.push_back(grid_.index_to_mm.apply(index));
        const Vec3 slope = (1 - part) * slope_at(from) + part * slope_at(to);
        Vec3 gradient;
        for (std::size_t n = 0; n < 3; ++n) {
            const std::array<double, 3>& row = to_index_.linear[n];
            gradient += slope[static_cast<int>(n)] * Vec3{row[0], row[1], row[2]};
        }
        mesh_.normals.push_back(-normalized(gradient));
    }

    double value(const Index3& at) const { return values_[grid_.offset(at.i, at.j, at.k)]; }

    /// By differences; the window goes on for some voxels around the object.
    Vec3 slope_at(const Index3& at) const {
        Vec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
            Index3 low = at, high = at;
            low[axis] = std::max(low[axis] - 1, std::int64_t{0});
            high[axis] = std::min(high[axis] + 1, grid_.size[axis] - 1);
            slope[axis] = (value(high) - value(low)) / static_cast<double>(high[axis] - low[axis]);
        }
        return slope;
    }

    /// Of the lines that begin at the voxels of a slice, by voxel and axis: one more than the number of their points.
    /// Numbers up to those that were there before the slice's first layer are of another slice.
    struct Slice {
        std::vector<std::uint32_t> points;
        std::size_t earlier_points = 0;
    };
    Slice& slice_of(std::int64_t k) { return slices_[static_cast<std::size_t>(k & 1)]; }

    const Grid& grid_;
    std::vector<float> values_;
    Affine3 to_index_;
    bool is_mirrored_;
    std::array<Slice, 2> slices_;
    TriangleMesh mesh_;
};

TriangleMesh mesh_of(const Grid& grid, std::vector<float> values, const Work& work) {
    MeshBuilder builder(grid, std::move(values));
    for (std::int64_t k = 0; k + 1 < grid.size.k; ++k) {
        work.check();
        builder.add_layer(k);
    }
    return builder.finish();
}

/// Adds g to values of f0 at the window's voxels.
void add_change(const ExistingSurface& surface, const SurfaceChange& change, std::vector<float>& values, const Work& work) {
    const Grid& window = surface.window();
    const IndexBox in_grid = surface.window_box();
    const std::optional<IndexBox> box = change.is_zero() ? std::nullopt : index_box(window, change.box());
    if (!box) return;
    const auto shifted = [&](const Index3& v) {
        return Index3{v.i + in_grid.low.i, v.j + in_grid.low.j, v.k + in_grid.low.k};
    };
    const ChangeLattice lattice(surface, change, {shifted(box->low), shifted(box->high)}, work);
    parallel_for(box->size().k, 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = box->low.k + begin; k < box->low.k + end; ++k)
            for (std::int64_t j = box->low.j; j <= box->high.j; ++j)
                for (std::int64_t i = box->low.i; i <= box->high.i; ++i) {
                    float& value = values[window.offset(i, j, k)];
                    if (std::abs(static_cast<double>(value)) <= lattice.near_mm())
                        value += static_cast<float>(lattice.at(shifted({i, j, k})));
                }
    });
}

/// Gives the values at the window's voxels the signs of a mask, whose grid is the surface's.
void keep_signs(const ExistingSurface& surface, const Mask& mask, std::vector<float>& values, const Work& work) {
    const Grid& window = surface.window();
    const Index3 low = surface.window_box().low, whole = mask.grid.size;
    const float least = least_value(surface);
    parallel_for(window.size.k, 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k)
            for (std::int64_t j = 0; j < window.size.j; ++j) {
                const std::int64_t y = j + low.j, z = k + low.k;
                const bool is_in_grid = y >= 0 && z >= 0 && y < whole.j && z < whole.k;
                float* values_of_row = values.data() + window.offset(0, j, k);
                for (std::int64_t i = 0; i < window.size.i; ++i) {
                    const std::int64_t x = i + low.i;
                    const bool is_inside =
                        is_in_grid && x >= 0 && x < whole.i && mask.values[mask.grid.offset(x, y, z)] != 0;
                    values_of_row[i] = is_inside ? std::max(values_of_row[i], least) : std::min(values_of_row[i], -least);
                }
            }
    });
}

}  // namespace

TriangleMesh existing_mesh(const ExistingSurface& surface, const Work& work) {
    return mesh_of(surface.window(), unshrunk_values(surface, work), work);
}

TriangleMesh corrected_mesh(const ExistingSurface& surface, std::vector<float> unshrunk, const SurfaceChange& change,
                            const Mask& corrected, const Work& work) {
    add_change(surface, change, unshrunk, work);
    keep_signs(surface, corrected, unshrunk, work);
    return mesh_of(surface.window(), std::move(unshrunk), work);
}

}  // namespace kontur
