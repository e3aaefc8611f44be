// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/polygonize.h"

#include <algorithm>
#include <unordered_map>

#include "kontur/base/error.h"
#include "kontur/extract/cell_triangles.h"

namespace kontur {
namespace {

constexpr std::size_t kPointsPerCell = 1;  ///< a cell has about as many cut edges of its own

/// Where f vanishes between two lattice values of different sign, as a fraction of the edge. Kept off the ends, so that no
/// triangle collapses; an edge that leaves the grid is cut in its middle.
double cut(double from, double to) {
    if (!std::isfinite(from) || !std::isfinite(to)) return 0.5;
    return std::clamp(from / (from - to), 1e-4, 1 - 1e-4);
}

class MeshBuilder {
public:
    explicit MeshBuilder(const SurfaceLattice& surface)
        : lattice_(surface.lattice),
          mm_to_index_(lattice_.grid().index_to_mm.inverse()),
          mirrored_(lattice_.grid().index_to_mm.determinant() < 0) {
        points_.reserve(2 * surface.cells.size());
    }

    void add_cell(const Index3& cell) {
        const std::array<double, 8> corners = lattice_.corners(cell);
        for (const CellTriangle& t : cell_triangles(inside_corners(corners))) {
            std::array<std::uint32_t, 3> triangle{point_on(cell, t[0], corners), point_on(cell, t[1], corners),
                                                  point_on(cell, t[2], corners)};
            if (mirrored_) std::swap(triangle[1], triangle[2]);
            mesh_.triangles.push_back(triangle);
        }
    }

    /// Normals are those of `function`, which knows nothing of the cut at the grid's border: there, the border's.
    TriangleMesh finish(FastFunction& function, const Progress& progress) {
        mesh_.normals.resize(mesh_.points.size());
        function.gradients(mesh_.points, mesh_.normals, progress);
        for (Vec3& n : mesh_.normals) n = -normalized(n);
        for (const auto& [point, normal] : border_normals_) mesh_.normals[point] = normal;
        return std::move(mesh_);
    }

private:
    std::uint32_t point_on(const Index3& cell, int edge_number, const std::array<double, 8>& corners) {
        const CellEdge& edge = cell_edges()[static_cast<std::size_t>(edge_number)];
        const Index3 from = Lattice::corner(cell, edge.from);
        const Index3& size = lattice_.grid().size;
        const auto linear =
            static_cast<std::uint64_t>((from.i + 1) + (size.i + 2) * ((from.j + 1) + (size.j + 2) * (from.k + 1)));
        const auto [found, is_new] = points_.try_emplace(3 * linear + static_cast<std::uint64_t>(edge.axis),
                                                         static_cast<std::uint32_t>(mesh_.points.size()));
        if (is_new) {
            if (mesh_.points.size() >= std::numeric_limits<std::uint32_t>::max())
                throw Error(ErrorKind::too_large, "the surface has more than 4294967295 points; use a larger spacing");
            Vec3 at{static_cast<double>(from.i), static_cast<double>(from.j), static_cast<double>(from.k)};
            at[edge.axis] += cut(corners[static_cast<std::size_t>(edge.from)], corners[static_cast<std::size_t>(edge.to)]);
            mesh_.points.push_back(lattice_.grid().index_to_mm.apply(at));
            if (!lattice_.in_grid(from)) border_normals_.emplace_back(found->second, -border_normal(edge.axis));
            if (!lattice_.in_grid(Lattice::corner(cell, edge.to)))
                border_normals_.emplace_back(found->second, border_normal(edge.axis));
        }
        return found->second;
    }

    /// Normal of the grid's face at its high end along an axis.
    Vec3 border_normal(int axis) const {
        const std::array<double, 3>& row = mm_to_index_.linear[static_cast<std::size_t>(axis)];
        return normalized({row[0], row[1], row[2]});
    }

    const Lattice& lattice_;
    Affine3 mm_to_index_;
    bool mirrored_;
    std::unordered_map<std::uint64_t, std::uint32_t> points_;  ///< lattice edge -> point
    TriangleMesh mesh_;
    std::vector<std::pair<std::uint32_t, Vec3>> border_normals_;
};

}  // namespace

TriangleMesh polygonize(const SurfaceLattice& surface, FastFunction& function, const Progress& progress) {
    MeshBuilder builder(surface);
    for (const Index3& cell : surface.cells) builder.add_cell(cell);
    progress.report("polygonize", 0.5);
    return builder.finish(function, progress);
}

TriangleMesh polygonize(const SurfaceLattice& surface, const ImplicitFunction& function, int threads,
                        const Progress& progress) {
    FastFunction fast(
        function, {.expected_points = static_cast<std::int64_t>(kPointsPerCell * surface.cells.size()), .threads = threads});
    return polygonize(surface, fast, progress);
}

}  // namespace kontur
