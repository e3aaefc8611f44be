// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/polygonize.h"

#include <algorithm>
#include <unordered_map>

#include "kontur/base/error.h"
#include "kontur/extract/cell_triangles.h"

namespace kontur {
namespace {

/// Where f vanishes between two lattice values of different sign, as a fraction of the edge. Kept off the ends, so that no
/// triangle collapses; an edge that leaves the grid is cut in its middle.
double cut(double from, double to) {
    if (!std::isfinite(from) || !std::isfinite(to)) return 0.5;
    return std::clamp(from / (from - to), 1e-4, 1 - 1e-4);
}

class MeshBuilder {
public:
    explicit MeshBuilder(const SurfaceLattice& surface) : lattice_(surface.lattice) {
        points_.reserve(2 * surface.cells.size());
        mirrored_ = lattice_.grid().index_to_mm.determinant() < 0;
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

    TriangleMesh finish() { return std::move(mesh_); }

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
        }
        return found->second;
    }

    const Lattice& lattice_;
    bool mirrored_;
    std::unordered_map<std::uint64_t, std::uint32_t> points_;  ///< lattice edge -> point
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh polygonize(const SurfaceLattice& surface, const ImplicitFunction& function, int threads,
                        const Progress& progress) {
    MeshBuilder builder(surface);
    for (const Index3& cell : surface.cells) builder.add_cell(cell);
    TriangleMesh mesh = builder.finish();

    progress.report("polygonize", 0.5);
    mesh.normals.resize(mesh.points.size());
    function.gradients(mesh.points, mesh.normals, threads);
    for (Vec3& n : mesh.normals) n = -normalized(n);
    return mesh;
}

}  // namespace kontur
