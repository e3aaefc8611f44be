// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/walk_surface.h"

#include <algorithm>
#include <cmath>

#include "kontur/image/refit.h"
#include "kontur/image/walked_data.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr double kMostOnContours = 0.05;  // voxels: f changes no more at drawn points
constexpr double kMostStray = 2.5;        // cells: no farther from the walk's surface
constexpr double kMostInPlanes = 1;       // cells: no farther from the contours in drawn planes

/// From one attempt to the next less is told near the contours, and less exactly.
constexpr WalkedDataOptions kAttempts[] = {{}, {.off_contours = 2, .noise = 4}};

/// Whether a surface is farther from the walk's than it may be.
bool leaves(const VoxelWalk& walk, const CellDepths& depths, const std::vector<float>& walked, const ImageCells& cells) {
    for (std::size_t n = 0; n < walked.size(); ++n)
        if (depths.is_inside(n) != walk.is_inside(n) && is_longer(std::abs(walked[n]), kMostStray, cells)) return true;
    return false;
}

/// Whether a surface comes through drawn planes where nothing was drawn. Depths tell of which cells that may be; the
/// functions' values there, which are exact, decide.
bool comes_through_planes(const ImplicitFunction& now, const CellDepths& now_depths, const ImplicitFunction& alone,
                          const CellDepths& alone_depths, const WalkedImage& image, const Work& work) {
    const std::array<Vec3, 3> half_edges = image.cells.half_edges();
    std::vector<Vec3> places;
    for (std::size_t n = 0; n < now_depths.depth_mm.size(); ++n)
        if (now_depths.is_inside(n) != alone_depths.is_inside(n) &&
            is_longer(std::abs(alone_depths.depth_mm[n]), kMostInPlanes, image.cells) &&
            image.walls.is_in_plane(image.cells.center(n), half_edges))
            places.push_back(image.cells.center(n));
    std::vector<double> before(places.size()), after(places.size());
    alone.values(places, before, work);
    now.values(places, after, work);
    for (std::size_t n = 0; n < places.size(); ++n)
        if ((before[n] > 0) != (after[n] > 0)) return true;
    return false;
}

/// Places of the surface, evenly, and how far it moved.
struct Moved {
    std::vector<ImageShare> shares;
    double most_mm = 0;
};

Moved moved(const ImplicitFunction& function, const CellDepths& now, const VoxelWalk& walk, const CellDepths& alone,
            const ImageCells& cells, const Affine3& frame, std::size_t count, const Work& work) {
    std::vector<Vec3> places;
    Moved moved;
    for (const std::uint32_t cell : walk.asked) {
        if (std::abs(static_cast<double>(now.depth_mm[cell])) > cells.edge_mm()) continue;
        places.push_back(cells.center(cell));
        moved.most_mm = std::max(moved.most_mm, std::abs(static_cast<double>(alone.depth_mm[cell])));
    }
    places = spread(places, count, frame);
    slide_to_surface(function, places, {.reach_mm = cells.edge_mm(), .steps = 2}, work);
    for (const Vec3& p : places) moved.shares.push_back({p, 1});
    return moved;
}

}  // namespace

std::optional<ImageFit> walk_surface(const WalkedImage& image, const Drawing& drawing, const PreparedContours& prepared,
                                     const FittedFunction& fitted, const AskedSurface* begin, const ImageOptions& options,
                                     double voxel_mm, const Work& work) {
    const ImageCells& cells = image.cells;
    const Affine3 frame = frame_of(drawing.contours);
    const CellDepths alone = cell_depths(cells, fitted.function, drawing.contours, work);
    const WalkOptions walking{image.walls, image.beliefs.prior_mm, drawing.diameter_mm()};
    const CellDepths first =
        begin ? moved_depths(alone, cells, fitted.function, begin->movement, begin->beliefs, {}, work) : alone;
    const VoxelWalk walk = walk_voxels(cells, first, walking, work);
    const Depths walked = depths_below(walk, cells);
    Refit refit(prepared, fitted, options.fit, cells.edge_mm());
    for (const WalkedDataOptions& attempt : kAttempts) {
        work.check();
        FittedFunction through = refit.with(
            walked_data(walk, walked, cells, alone, fitted, frame, drawing.diameter_mm() / 2, attempt, work), work);
        const double on_contours = largest_change(fitted.function, through.function, drawing.contours, work);
        const CellDepths now = cell_depths(cells, through.function, drawing.contours, work, Doubts::left);
        if (on_contours > kMostOnContours * voxel_mm || leaves(walk, now, walked.depth_mm, cells) ||
            comes_through_planes(through.function, now, fitted.function, alone, image, work))
            continue;
        Moved places = moved(through.function, now, walk, alone, cells, frame, options.samples, work);
        ImageFit result{std::move(through), {.verdict = ImageVerdict::used}};
        result.report.walked = true;
        result.report.on_contours_mm = on_contours;
        result.report.shares = std::move(places.shares);
        result.report.largest_move_mm = places.most_mm;
        return result;
    }
    return std::nullopt;
}

}  // namespace kontur
