// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/cell_depths.h"

#include <cmath>

#include "kontur/base/distance_transform.h"
#include "kontur/extract/adaptive.h"
#include "kontur/extract/voxelize.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr double kTolerance = 0.02;  // of f, in edges

std::vector<std::uint8_t> cells_on(const ContourSet& contours, const ImageCells& cells) {
    std::vector<std::uint8_t> marks(cells.looks.size());
    const Affine3 to_index = cells.grid.index_to_mm.inverse();
    for (const Vec3& p : along_contours(contours, 0.5 * cells.edge_mm()))
        for (const double x : {-kBetweenCells, kBetweenCells})
            for (const double y : {-kBetweenCells, kBetweenCells})
                for (const double z : {-kBetweenCells, kBetweenCells}) {
                    const Index3 cell = nearest_index(to_index.apply(p) + Vec3{x, y, z});
                    if (cells.holds(cell)) marks[cells.offset(cell)] = 1;
                }
    return marks;
}

/// The cells inside that have a neighbour outside, or lie at the grid's border.
std::vector<std::uint8_t> just_below_surface(const std::vector<std::uint8_t>& inside, const ImageCells& cells) {
    std::vector<std::uint8_t> marks(inside.size());
    for (std::size_t n = 0; n < inside.size(); ++n) {
        if (!inside[n]) continue;
        int around = 0;
        cells.visit_neighbours(n, [&](int, std::size_t next) { around += inside[next]; });
        marks[n] = around < 6;
    }
    return marks;
}

}  // namespace

Depths depths_of(const std::vector<std::uint8_t>& inside, const ImageCells& cells) {
    DistanceTransform transform = distance_transform(cells.grid.size, just_below_surface(inside, cells));
    const auto edge = static_cast<float>(cells.edge_mm());
    for (std::size_t n = 0; n < inside.size(); ++n)
        transform.distances[n] = edge * (inside[n] ? transform.distances[n] + 0.5F : 0.5F - transform.distances[n]);
    return {std::move(transform.distances), std::move(transform.nearest)};
}

CellDepths cell_depths(const ImageCells& cells, const ImplicitFunction& function, const ContourSet& contours,
                       const Work& work, Doubts doubts) {
    std::vector<Vec3> starts;
    for (const Contour& contour : contours.contours)
        starts.insert(starts.end(), contour.points.begin(), contour.points.end());
    // The lattice reaches beyond all starts. Depths are known to half a cell, to which values in doubt do not matter.
    FastFunction fast(function, {.tolerance_mm = kTolerance * cells.edge_mm(),
                                 .expected_points = expected_surface_voxels(cells.grid, starts)});
    Depths depths =
        depths_of(fill(track_surface_adaptively(fast, cells.grid, starts, work.untold(), doubts), work).values, cells);
    std::vector<float> far = distance_transform(cells.grid.size, cells_on(contours, cells)).distances;
    for (float& mm : far) mm *= static_cast<float>(cells.edge_mm());
    return {std::move(depths.depth_mm), std::move(far), std::move(depths.nearest)};
}

CellDepths between(const CellDepths& first, const CellDepths& second, double share) {
    CellDepths depths = share < 1 ? first : second;
    if (share <= 0 || share >= 1) return depths;
    for (std::size_t n = 0; n < depths.depth_mm.size(); ++n)
        depths.depth_mm[n] += static_cast<float>(share) * (second.depth_mm[n] - first.depth_mm[n]);
    return depths;
}

CellDepths moved_depths(const CellDepths& depths, const ImageCells& cells, const MovedSurface& surface, const CellSlab& near,
                        const Work& work) {
    const auto& [function, movement, beliefs] = surface;
    if (movement.points.empty()) return depths;
    std::vector<std::size_t> below;
    std::vector<Vec3> on_surface;
    for (std::size_t n = 0; n < depths.nearest.size(); ++n) {
        if (depths.nearest[n] != n || !depths.is_inside(n) || !near.holds(cells.center(n))) continue;
        below.push_back(n);
        on_surface.push_back(cells.center(n));
    }
    // The normals half a cell below the surface are about those on it.
    const std::vector<Vec3> gradients = slide_to_surface(function, on_surface, {.reach_mm = cells.edge_mm()}, work);
    std::vector<float> offsets(depths.nearest.size());
    for (std::size_t n = 0; n < below.size(); ++n) {
        MovingPoint at{on_surface[n], -normalized(gradients[n])};
        at.distance_mm = static_cast<double>(depths.far_mm[below[n]]);
        at.prior_mm = beliefs.prior_mm(at.distance_mm);
        offsets[below[n]] = static_cast<float>(offset_at(at, movement.points, movement.prior, movement.offsets));
    }
    CellDepths result = depths;
    for (std::size_t n = 0; n < offsets.size(); ++n) result.depth_mm[n] += offsets[depths.nearest[n]];
    return result;
}

}  // namespace kontur
