// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/existing_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "kontur/extract/cell_triangles.h"

namespace kontur {
namespace {

class MeshBuilder {
public:
    explicit MeshBuilder(const ExistingSurface& surface)
        : grid_(surface.window()),
          values_(surface.window_values()),
          to_index_(grid_.index_to_mm.inverse()),
          is_mirrored_(grid_.index_to_mm.determinant() < 0) {}

    /// The cells between slices k and k + 1.
    void add_layer(std::int64_t k) {
        const Index3& size = grid_.size;
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
        const std::size_t at = grid_.offset(from.i, from.j, from.k);
        const auto [found, is_new] = points_.try_emplace(3 * at + static_cast<std::size_t>(edge.axis),
                                                         static_cast<std::uint32_t>(mesh_.points.size()));
        if (is_new) add_point(from, edge.axis);
        return found->second;
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

    const Grid& grid_;
    std::span<const float> values_;
    Affine3 to_index_;
    bool is_mirrored_;
    std::unordered_map<std::size_t, std::uint32_t> points_;  ///< of a line between two voxels, by the lower one and the axis
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh existing_mesh(const ExistingSurface& surface, const Work& work) {
    MeshBuilder builder(surface);
    for (std::int64_t k = 0; k + 1 < surface.window().size.k; ++k) {
        work.check();
        builder.add_layer(k);
    }
    return builder.finish();
}

}  // namespace kontur
