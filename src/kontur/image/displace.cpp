// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/displace.h"

#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/base/point_tree.h"
#include "kontur/sampling/plane_groups.h"
#include "kontur/sampling/quantile.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr std::size_t kMostPlanes = 5;
constexpr double kPoints = 500;              // of all planes together, displaced
constexpr double kLeastDisplacement = 0.5;   // voxels
constexpr double kSupposedImageError = 0.7;  // voxels: how wrong the image is, until that is measured here
constexpr double kLargest = 3;               // displacements: errors larger than this say no more

/// Of the places between the contours, a voxel and more off.
std::optional<double> median_distance_mm(const Drawing& drawing, const ImplicitFunction& function, double voxel_mm,
                                         const Work& work) {
    const double spacing = kFoldSpacing * drawing.diameter_mm();
    const PointTree contours(
        along_contours(drawing.contours, std::max(voxel_mm, length_mm(drawing.contours) / kMostContourPoints)));
    std::vector<double> distances;
    for (const Vec3& p : points_of_surface(function, drawing.contours, spacing, work)) {
        const double far = contours.distance_to(p);
        if (far > voxel_mm) distances.push_back(far);
    }
    if (distances.size() < kLeastPoints) return std::nullopt;
    return median(std::move(distances));
}

struct DisplacementTrial {
    const Image& image;
    const ImplicitFunction& function;
    double distance_mm, by_mm, voxel_mm, step_mm;

    Beliefs beliefs() const {
        return {[mm = by_mm](double) { return mm; }, [mm = kSupposedImageError * voxel_mm](double) { return mm; }};
    }
};

/// What the image makes of the surface beside the contours of a plane which it has not seen; `side` 1 is outwards.
PlaneErrors displace(const DisplacementTrial& trial, const Surroundings& others,
                     const std::vector<MovingPoint>& contour_points, double side, const Work& alone) {
    std::vector<Vec3> beside;
    for (const MovingPoint& p : contour_points) beside.push_back(p.position + side * trial.by_mm * p.normal);
    const Movement movement = find_movement(others, trial.function, beside, trial.beliefs(), alone);
    PlaneErrors errors{{}, movement.intensities};
    if (movement.points.empty()) return errors;
    std::vector<MovingPoint> at = with_normals(trial.function, beside, alone);
    others.walls.limit(at);
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (at[i].normal == Vec3{} || nearest_distance(at[i].position, others.points) <= trial.voxel_mm) continue;
        at[i].prior_mm = trial.by_mm;
        const double error = dot(contour_points[i].position - at[i].position, at[i].normal);
        const double offset = offset_at(at[i], movement.points, movement.prior, movement.offsets);
        const double reachable = std::clamp(error, at[i].least_mm, at[i].most_mm);
        errors.points.push_back({trial.distance_mm, error, error - offset, reachable, 0});
    }
    return errors;
}

PlaneErrors displace(const DisplacementTrial& trial, const ContourSet& contours, const PlaneGroup& group,
                     const Work& alone) {
    PlaneErrors errors;
    try {
        const Surroundings others(Drawing(without(contours, group), FillRule::declared), trial.image);
        const std::vector<MovingPoint> contour_points =
            with_normals(trial.function, along_contours(only(contours, group), trial.step_mm), alone);
        for (const double side : {1.0, -1.0}) {
            const PlaneErrors part = displace(trial, others, contour_points, side, alone);
            errors.points.insert(errors.points.end(), part.points.begin(), part.points.end());
            errors.intensities += part.intensities;
        }
    } catch (const Error& error) {
        // What is left of a drawing may be too little to be one.
        if (error.kind() == ErrorKind::cancelled) throw;
    }
    return errors;
}

}  // namespace

std::optional<HeldOutErrors> displace_planes(const Drawing& drawing, const Image& image, const ImplicitFunction& function,
                                             const Work& work) {
    const std::vector<PlaneGroup> groups = contours_by_plane(drawing.contours);
    if (groups.size() < kFewestPlanes || groups.size() > kMostPlanes) return std::nullopt;
    const double voxel = Intensities(image).voxel_mm();
    const std::optional<double> far = median_distance_mm(drawing, function, voxel, work);
    if (!far) return std::nullopt;
    const double step = std::max(voxel, length_mm(drawing.contours) / kPoints);
    const DisplacementTrial trial{image, function, *far, kMostPriorSlope * *far, voxel, step};

    std::vector<PlaneErrors> planes(groups.size());
    const Work alone{.threads = 1, .stop = work.stop};  // planes are asked beside each other
    parallel_for(static_cast<std::int64_t>(groups.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            planes[i] = displace(trial, drawing.contours, groups[i], alone);
            for (HeldOutPoint& point : planes[i].points) point.plane = i;
        }
    });
    if (!tell_enough(planes)) return std::nullopt;
    const Beliefs beliefs{[](double d) { return kMostPriorSlope * d; }};
    HeldOutErrors errors(planes, beliefs, kLargest * trial.by_mm + voxel, voxel);
    if (errors.without_mm() < kLeastDisplacement * voxel) return std::nullopt;
    return errors;
}

}  // namespace kontur
