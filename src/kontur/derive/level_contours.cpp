// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/level_contours.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "kontur/extract/isolines.h"

namespace kontur {
namespace {

/// The voxels of the image that the levels' box holds.
std::optional<IndexBox> voxels_of(const Levels& levels, const Index3& steps, const Index3& size) {
    IndexBox voxels;
    for (int axis = 0; axis < 3; ++axis) {
        if (levels.box.high[axis] < 0) return std::nullopt;
        voxels.low[axis] = std::max<std::int64_t>(0, (levels.box.low[axis] + steps[axis] - 1) / steps[axis]);
        voxels.high[axis] = std::min(size[axis] - 1, levels.box.high[axis] / steps[axis]);
        if (voxels.low[axis] > voxels.high[axis]) return std::nullopt;
    }
    return voxels;
}

/// Axes are steps of the image, so that (u, v) are voxel indices.
IsolineLattice lattice_of(const Grid& image, const IndexBox& voxels, std::int64_t k) {
    const Vec3 u = image.index_to_mm.column(0), v = image.index_to_mm.column(1);
    IsolineLattice lattice;
    lattice.plane = {image.center_mm(0, 0, k), normalized(cross(u, v)), u, v};
    lattice.u_min_mm = static_cast<double>(voxels.low.i);
    lattice.v_min_mm = static_cast<double>(voxels.low.j);
    lattice.columns = voxels.size().i;
    lattice.rows = voxels.size().j;
    return lattice;
}

Plane orthonormal(Plane plane) {
    plane.u = normalized(plane.u);
    plane.v = cross(plane.normal, plane.u);
    return plane;
}

}  // namespace

ContourSet level_contours(const Levels& levels, const WorkLattice& lattice, const Grid& image) {
    const Index3 steps = steps_per_voxel(lattice);
    ContourSet set;
    const std::optional<IndexBox> voxels = voxels_of(levels, steps, image.size);
    if (!voxels) return set;
    for (std::int64_t k = voxels->low.k; k <= voxels->high.k; ++k) {
        std::vector<double> values;
        for (std::int64_t j = voxels->low.j; j <= voxels->high.j; ++j)
            for (std::int64_t i = voxels->low.i; i <= voxels->high.i; ++i)
                values.push_back(static_cast<double>(levels.at({i * steps.i, j * steps.j, k * steps.k})));
        const IsolineLattice nodes = lattice_of(image, *voxels, k);
        const Plane plane = orthonormal(nodes.plane);
        for (const Isoline& line : isolines(nodes, values)) {
            Contour& contour = set.contours.emplace_back(Contour{.plane = plane, .points = {}, .hole = line.hole});
            for (const auto& [u, v] : line.points) contour.points.push_back(nodes.plane.from_uv(u, v));
        }
    }
    drop_duplicate_points(set);
    return set;
}

}  // namespace kontur
