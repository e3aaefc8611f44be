// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/leave_out.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/image/voxel_walk.h"
#include "kontur/sampling/plane_groups.h"
#include "kontur/sampling/quantile.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr std::size_t kMostPlanes = 10;
constexpr std::size_t kSamples = 300;
constexpr double kHeldOutPoints = 500;       // of all planes together
constexpr double kAskedBeside = 8;           // cells beside the plane left out: walks from farther off hardly reach it
constexpr std::size_t kMostCells = 150'000;  // of the lattice for walks

/// One plane left out: the surface through the others, and where it should have passed.
struct Fold {
    ContourSet plane, rest;
    ImplicitFunction function;
    Surroundings others;
    std::vector<Vec3> samples;
    std::vector<Vec3> held_out;           ///< drawn points
    std::vector<MovingPoint> on_surface;  ///< the points of the surface nearest to them
    std::vector<double> errors_mm;        ///< how far the surface has to move there
};

/// What all folds are made from.
struct FoldSource {
    const ContourSet& contours;
    const Image& image;
    const FitContours& fit;
    double step_mm;  ///< from one held-out point to the next
};

std::optional<Fold> leave_out(const FoldSource& source, const PlaneGroup& group, const Work& alone) {
    try {
        const Drawing rest(without(source.contours, group), FillRule::declared);
        Fold fold{only(source.contours, group),
                  rest.contours,
                  source.fit(rest.contours),
                  Surroundings(rest, source.image),
                  {},
                  {},
                  {},
                  {}};
        const double spacing = kFoldSpacing * rest.diameter_mm();
        fold.samples =
            spread(points_of_surface(fold.function, rest.contours, spacing, alone), kSamples, frame_of(rest.contours));
        if (fold.samples.size() < kLeastPoints) return std::nullopt;
        slide_to_surface(fold.function, fold.samples, {.reach_mm = spacing}, alone);
        alone.check();
        fold.held_out = along_contours(fold.plane, source.step_mm);
        std::vector<Vec3> nearest = fold.held_out;
        slide_to_surface(fold.function, nearest, {.reach_mm = 0.25 * rest.diameter_mm(), .steps = 3}, alone);
        fold.on_surface = with_normals(fold.function, nearest, alone);
        for (std::size_t i = 0; i < nearest.size(); ++i) {
            fold.on_surface[i].distance_mm = nearest_distance(nearest[i], fold.others.points);
            fold.errors_mm.push_back(dot(fold.held_out[i] - nearest[i], fold.on_surface[i].normal));
        }
        return fold;
    } catch (const Error& error) {
        // What is left of a drawing may be too little to be one.
        if (error.kind() == ErrorKind::cancelled) throw;
        return std::nullopt;
    }
}

/// What the folds say before the image is looked at. Errors grow with the distance from the contours to the power of 1.5.
struct PlainErrors {
    double factor = 0;    ///< standard deviation = factor distance^1.5
    double limit_mm = 0;  ///< errors larger than this say no more
};

std::optional<PlainErrors> plain_errors(const std::vector<std::optional<Fold>>& folds, double voxel_mm) {
    std::vector<double> ratios, errors;
    for (const auto& fold : folds) {
        if (!fold) continue;
        for (std::size_t i = 0; i < fold->errors_mm.size(); ++i) {
            const double error = std::abs(fold->errors_mm[i]), far = fold->on_surface[i].distance_mm;
            errors.push_back(error);
            if (far > voxel_mm) ratios.push_back(error / std::pow(far, 1.5));
        }
    }
    if (ratios.size() < kLeastPoints) return std::nullopt;
    return PlainErrors{kDeviationOfMedian * median(std::move(ratios)), 1.5 * quantile(std::move(errors), 0.9) + voxel_mm};
}

PlaneErrors errors_with_image(Fold& fold, std::size_t plane, const Beliefs& beliefs, const Movement& movement,
                              double voxel_mm) {
    PlaneErrors errors{{}, movement.intensities};
    fold.others.walls.limit(fold.on_surface);
    for (std::size_t i = 0; i < fold.held_out.size(); ++i) {
        MovingPoint& at = fold.on_surface[i];
        if (at.distance_mm <= voxel_mm) continue;
        at.prior_mm = beliefs.prior_mm(at.distance_mm);
        const double offset = offset_at(at, movement.points, movement.prior, movement.offsets);
        const double error = fold.errors_mm[i], reachable = std::clamp(error, at.least_mm, at.most_mm);
        errors.points.push_back({at.distance_mm, error, error - offset, reachable, plane});
    }
    return errors;
}

/// Which cells in the plane are on the wrong side: by the fold's surface, by that moved, and by a walk that begins with the
/// surface moved as far as the image is followed.
WrongCells walk(const Fold& fold, const MovedSurface& surface, const ImageCells& cells, double moving, const Work& alone) {
    const CellSlab near{fold.plane.contours.front().plane, kAskedBeside * cells.edge_mm()};
    const CellDepths depths = cell_depths(cells, fold.function, fold.rest, alone, Doubts::left);
    const CellDepths by_movement = moved_depths(depths, cells, surface, near, alone);
    const WalkOptions options{fold.others.walls, surface.beliefs.prior_mm, smallest_ball(fold.rest).diameter(), near};
    const VoxelWalk walk = walk_voxels(cells, between(depths, by_movement, moving), options, alone);
    return count_wrong(fold.plane, cells, depths, by_movement, walk);
}

}  // namespace

std::optional<LeftOutPlanes> leave_planes_out(const Drawing& drawing, const Image& image, const FitContours& fit,
                                              const Work& work) {
    const ContourSet& contours = drawing.contours;
    const std::vector<PlaneGroup> groups = at_most(kMostPlanes, contours_by_plane(contours));
    if (groups.size() < kFewestPlanes) return std::nullopt;
    const double voxel = Intensities(image).voxel_mm();
    const FoldSource source{contours, image, fit, std::max(voxel, length_mm(contours) / kHeldOutPoints)};
    std::vector<std::optional<Fold>> folds(groups.size());
    const Work alone{.threads = 1, .stop = work.stop};  // folds are computed beside each other
    parallel_for(static_cast<std::int64_t>(groups.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            folds[i] = leave_out(source, groups[i], alone);
    });
    const std::optional<PlainErrors> plain = plain_errors(folds, voxel);
    if (!plain) return std::nullopt;
    const Beliefs beliefs{[plain = *plain](double d) {
        return std::min({plain.factor * std::pow(d, 1.5), kMostPriorSlope * d, plain.limit_mm});
    }};
    std::vector<PlaneErrors> errors(folds.size());
    std::vector<Movement> movements(folds.size());
    parallel_for(static_cast<std::int64_t>(folds.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            if (!folds[i]) continue;
            movements[i] = find_movement(folds[i]->others, folds[i]->function, folds[i]->samples, beliefs, alone);
            errors[i] = errors_with_image(*folds[i], i, beliefs, movements[i], voxel);
        }
    });
    if (!tell_enough(errors)) return std::nullopt;
    LeftOutPlanes left_out{HeldOutErrors(errors, beliefs, plain->limit_mm, voxel),
                           image_cells(image, contours, kMostCells, work), std::vector<WrongCells>(folds.size())};
    if (left_out.walk_visibility() == 0) return left_out;  // no walk would count
    const double moving = left_out.moving();
    parallel_for(static_cast<std::int64_t>(folds.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            if (folds[i])
                left_out.wrong[i] =
                    walk(*folds[i], {folds[i]->function, movements[i], beliefs}, left_out.cells, moving, alone);
    });
    return left_out;
}

}  // namespace kontur
