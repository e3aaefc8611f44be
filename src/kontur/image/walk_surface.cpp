// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/walk_surface.h"

#include <algorithm>
#include <cmath>

#include "kontur/image/refit.h"
#include "kontur/image/walk_data.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr double kMostOnContours = 0.05;  // voxels: f changes no more at drawn points
constexpr double kMostStray = 2.5;        // cells: no farther from the walk's surface

/// The second tells less near the contours, and less exactly.
constexpr WalkDataOptions kAttempts[] = {{}, {.off_contours = 2, .noise = 4}};

/// Whether a surface is farther from the walk's than it may be.
bool leaves(const VoxelWalk& walk, const CellDepths& depths, const std::vector<float>& walk_mm, const ImageCells& cells) {
    for (std::size_t n = 0; n < walk_mm.size(); ++n)
        if (depths.is_inside(n) != walk.is_inside(n) && is_longer(std::abs(walk_mm[n]), kMostStray, cells)) return true;
    return false;
}

/// The surface of a function, and how cells lie to it.
struct SurfaceDepths {
    const ImplicitFunction& function;
    const CellDepths& depths;
};

/// Whether a surface comes through drawn planes where nothing was drawn. Depths tell of which cells that may be; the
/// functions' values there, which are exact, decide.
bool comes_through_planes(const SurfaceDepths& now, const SurfaceDepths& alone, const WalkGround& ground, const Work& work) {
    const std::array<Vec3, 3> half_edges = ground.cells.half_edges();
    std::vector<Vec3> places;
    for (std::size_t n = 0; n < now.depths.depth_mm.size(); ++n)
        if (now.depths.is_inside(n) != alone.depths.is_inside(n) &&
            is_longer(std::abs(alone.depths.depth_mm[n]), 1, ground.cells) &&
            ground.walls.is_in_plane(ground.cells.center(n), half_edges))
            places.push_back(ground.cells.center(n));
    std::vector<double> before(places.size()), after(places.size());
    alone.function.values(places, before, work);
    now.function.values(places, after, work);
    for (std::size_t n = 0; n < places.size(); ++n)
        if ((before[n] > 0) != (after[n] > 0)) return true;
    return false;
}

/// Cells of the walk's band at the surface, and how far the surface moved.
struct SurfaceCells {
    std::vector<Vec3> places;
    double most_mm = 0;
};

SurfaceCells surface_cells(const CellDepths& now, const CellDepths& alone, const VoxelWalk& walk, const ImageCells& cells) {
    SurfaceCells result;
    for (const std::uint32_t cell : walk.band) {
        if (std::abs(static_cast<double>(now.depth_mm[cell])) > cells.edge_mm()) continue;
        result.places.push_back(cells.center(cell));
        result.most_mm = std::max(result.most_mm, std::abs(static_cast<double>(alone.depth_mm[cell])));
    }
    return result;
}

}  // namespace

std::optional<ImageFit> walk_surface(const WalkGround& ground, const FittedDrawing& fit, const SurfaceMovement* start,
                                     const ImageOptions& options, const Work& work) {
    const auto& [drawing, prepared, fitted] = fit;
    const ImageCells& cells = ground.cells;
    const CellDepths alone = cell_depths(cells, fitted.function, drawing.contours, work);
    const WalkOptions walking{ground.walls, ground.beliefs.prior_mm, drawing.diameter_mm()};
    const CellDepths first =
        start ? moved_depths(alone, cells, {fitted.function, start->movement, start->beliefs}, {}, work) : alone;
    const VoxelWalk walk = walk_voxels(cells, first, walking, work);
    const Depths depths = depths_below(walk, cells);
    Refit refit(prepared, fitted, options.fit, cells.edge_mm());
    for (const WalkDataOptions& attempt : kAttempts) {
        work.check();
        const ImageData data = walk_data({walk, depths, cells}, {fitted, alone}, drawing, attempt, work);
        FittedFunction through = refit.with(data, work);
        const double on_contours = largest_change(fitted.function, through.function, drawing.contours, work);
        const CellDepths now = cell_depths(cells, through.function, drawing.contours, work, Doubts::left);
        if (on_contours > kMostOnContours * ground.voxel_mm || leaves(walk, now, depths.depth_mm, cells) ||
            comes_through_planes({through.function, now}, {fitted.function, alone}, ground, work))
            continue;
        const SurfaceCells surface = surface_cells(now, alone, walk, cells);
        std::vector<Vec3> places = spread(surface.places, options.samples, frame_of(drawing.contours));
        slide_to_surface(through.function, places, {.reach_mm = cells.edge_mm(), .steps = 2}, work);
        ImageFit result{std::move(through), {.verdict = ImageVerdict::used}};
        result.report.walked = true;
        result.report.on_contours_mm = on_contours;
        result.report.largest_move_mm = surface.most_mm;
        for (const Vec3& p : places) result.report.shares.push_back({p, 1});
        return result;
    }
    return std::nullopt;
}

}  // namespace kontur
