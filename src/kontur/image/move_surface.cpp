// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/move_surface.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/point_tree.h"
#include "kontur/image/refit.h"
#include "kontur/image/searched_band.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr double kFollow = 0.05;           // noise of a moved point over its posterior standard deviation
constexpr double kLeastDeviation = 0.2;    // voxels
constexpr double kSurfaceSpacing = 0.025;  // of the drawing's diameter: of points of the surface of a fit
constexpr int kAttempts = 4;               // to keep the surface where the image was asked

/// f at the moved points is what it was where they came from.
std::vector<PointConstraint> observations(const Movement& movement, const ImplicitFunction& before, double voxel_mm,
                                          const Work& work) {
    std::vector<Vec3> from;
    for (const MovingPoint& p : movement.points) from.push_back(p.position);
    std::vector<double> values(from.size());
    before.values(from, values, work);
    std::vector<PointConstraint> constraints;
    for (std::size_t i = 0; i < from.size(); ++i)
        constraints.push_back({.position = from[i] + movement.offsets.mean_mm[i] * movement.points[i].normal,
                               .value = values[i],
                               .noise_mm = kFollow * std::max(movement.offsets.sd_mm[i], kLeastDeviation * voxel_mm)});
    return constraints;
}

/// How far the nearest point of the surface moves outwards.
double change_near(const Movement& movement, const Vec3& place) {
    const auto away = [&](const MovingPoint& point) { return distance(point.position, place); };
    const auto nearest = std::ranges::min_element(movement.points, {}, away);
    return movement.offsets.mean_mm[static_cast<std::size_t>(nearest - movement.points.begin())];
}

std::vector<ImageShare> image_shares(const Movement& movement) {
    std::vector<ImageShare> shares;
    for (std::size_t i = 0; i < movement.points.size(); ++i) {
        const MovingPoint& p = movement.points[i];
        const double share = std::clamp(movement.offsets.sd_mm[i] / p.prior_mm, 0.0, 1.0);
        shares.push_back({p.position + movement.offsets.mean_mm[i] * p.normal, share});
    }
    return shares;
}

/// As far from the surface as offsets are searched, and as points of it are apart.
SearchedBand searched_band(const std::vector<Vec3>& surface, const Surroundings& surroundings, const Beliefs& beliefs,
                           double spacing_mm) {
    const PointTree contours(surroundings.points);
    std::vector<double> reach;
    for (const Vec3& p : surface) reach.push_back(kSearched * beliefs.prior_mm(contours.distance_to(p)) + spacing_mm);
    return {surface, std::move(reach)};
}

/// Takes moves back near the places from which the surface ran away, the less the farther off.
void hold_back(Movement& movement, std::span<const Vec3> places) {
    for (std::size_t i = 0; i < movement.points.size(); ++i) {
        const double r = nearest_distance(movement.points[i].position, places) / movement.prior.length_mm;
        movement.offsets.mean_mm[i] *= 1 - std::exp(-0.5 * r * r);
    }
}

}  // namespace

SurfaceMovement surface_movement(const FittedDrawing& fit, const Surroundings& surroundings, const Beliefs& beliefs,
                                 std::size_t samples, const Work& work) {
    const ContourSet& contours = fit.drawing.contours;
    const ImplicitFunction& function = fit.fitted.function;
    SurfaceMovement surface{{}, kSurfaceSpacing * fit.drawing.diameter_mm(), beliefs, {}};
    surface.points = points_of_surface(function, contours, surface.spacing_mm, work);
    std::vector<Vec3> points = spread(surface.points, samples, frame_of(contours));
    slide_to_surface(function, points, {.reach_mm = surface.spacing_mm}, work);
    work.check();
    surface.movement = find_movement(surroundings, function, points, beliefs, work);
    return surface;
}

/// The image is asked once, as it was where contours were left out: asked again from the moved surface it would be believed
/// twice.
ImageFit move_surface(SurfaceMovement surface, const FittedDrawing& fit, const Surroundings& surroundings,
                      const FitOptions& options, const Work& work) {
    const auto& [drawing, prepared, fitted] = fit;
    const double voxel = surroundings.image.voxel_mm(), spacing = surface.spacing_mm;
    Movement& movement = surface.movement;
    ImageFit result{fitted, {}};
    result.report.intensities = movement.intensities;
    result.report.verdict = ImageVerdict::used;
    if (movement.points.empty()) return result;

    const SearchedBand band = searched_band(surface.points, surroundings, surface.beliefs, spacing);
    Refit refit(prepared, fitted, options, voxel);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        work.check();
        const auto change_mm = [&](const Vec3& p) { return change_near(movement, p); };
        const ImageData data{observations(movement, fitted.function, voxel, work), {}, change_mm};
        FittedFunction refitted = refit.with(data, work);
        const std::vector<Vec3> strays =
            band.left_from(points_of_surface(refitted.function, drawing.contours, spacing, work), work);
        if (strays.empty()) {
            result.fitted = std::move(refitted);
            result.report.on_contours_mm = largest_change(fitted.function, result.fitted.function, drawing.contours, work);
            result.report.shares = image_shares(movement);
            for (const double u : movement.offsets.mean_mm)
                result.report.largest_move_mm = std::max(result.report.largest_move_mm, std::abs(u));
            return result;
        }
        hold_back(movement, strays);
    }
    result.report.verdict = ImageVerdict::astray;
    return result;
}

}  // namespace kontur
