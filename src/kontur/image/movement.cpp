// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/movement.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/parallel.h"
#include "kontur/image/appearance.h"
#include "kontur/sampling/quantile.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr double kMostExamples = 700;  // along the contours
constexpr double kOnContour = 0.75;    // voxels: nearer points stay where they are
constexpr double kCorrelation = 0.8;   // of the median distance to the contours, at least two voxels
constexpr int kLeastSteps = 3, kMostSteps = 24;
constexpr double kWallSoftness = 0.25;  // steps

/// The points that may move, with all that is known of them without the image.
std::vector<MovingPoint> moving_points(const Surroundings& surroundings, const ImplicitFunction& function,
                                       std::span<const Vec3> points, const Beliefs& beliefs, const Work& work) {
    std::vector<MovingPoint> moving = with_normals(function, points, work);
    const double voxel = surroundings.image.voxel_mm();
    parallel_for(static_cast<std::int64_t>(moving.size()), 32, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            moving[i].distance_mm = nearest_distance(moving[i].position, surroundings.points);
            moving[i].prior_mm = std::max(beliefs.prior_mm(moving[i].distance_mm), kLeastPrior * voxel);
        }
    });
    std::erase_if(moving, [&](const MovingPoint& p) { return p.distance_mm <= kOnContour * voxel || p.normal == Vec3{}; });
    surroundings.walls.limit(moving);
    return moving;
}

/// How many steps to each side are searched. No prior is wider than what is.
int search_width(std::vector<MovingPoint>& points, double step_mm) {
    std::vector<double> priors;
    for (const MovingPoint& p : points) priors.push_back(p.prior_mm);
    const double steps = std::ceil(kSearched * quantile(std::move(priors), 0.95) / step_mm);
    const int most = static_cast<int>(std::clamp<double>(steps, kLeastSteps, kMostSteps));
    for (MovingPoint& p : points) p.prior_mm = std::min(p.prior_mm, 0.5 * most * step_mm);
    return most;
}

/// Beyond half a voxel before a drawn plane an offset is all but impossible.
void add_walls(const MovingPoint& point, double margin_mm, const OffsetEvidence& evidence,
               std::vector<double>& log_likelihood) {
    for (int u = -evidence.most; u <= evidence.most; ++u) {
        if (u == 0) continue;
        const double offset = u * evidence.step_mm;
        const double beyond = std::max({point.least_mm + margin_mm - offset, offset - point.most_mm + margin_mm, 0.0});
        const double off = beyond / (kWallSoftness * evidence.step_mm);
        log_likelihood[static_cast<std::size_t>(u + evidence.most)] -= 0.5 * off * off;
    }
}

}  // namespace

Surroundings::Surroundings(const Drawing& drawing, const Image& volume)
    : image(volume),
      points(along_contours(drawing.contours, std::max(image.voxel_mm(), length_mm(drawing.contours) / kMostContourPoints))),
      examples(along_contours(drawing.contours, std::max(image.voxel_mm(), length_mm(drawing.contours) / kMostExamples))),
      walls(drawing) {}

Movement find_movement(const Surroundings& surroundings, const ImplicitFunction& function, std::span<const Vec3> points,
                       const Beliefs& beliefs, const Work& work) {
    Movement movement{moving_points(surroundings, function, points, beliefs, work), {}, {}, 0};
    if (movement.points.size() < kLeastPoints) return {};
    const double step = surroundings.image.step_mm();
    OffsetEvidence evidence{
        .step_mm = step, .most = search_width(movement.points, step), .log_likelihood = {}, .image_sd_mm = {}};

    const std::vector<MovingPoint> examples = with_normals(function, surroundings.examples, work);
    const IntensityScale scale(intensities_across(surroundings.image, examples, step, work));
    const Appearance appearance(surroundings.image, scale, examples, step, work);
    evidence.log_likelihood.resize(movement.points.size());
    parallel_for(static_cast<std::int64_t>(movement.points.size()), 8, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            evidence.log_likelihood[i] = appearance.log_likelihood(movement.points[i], evidence.most);
            add_walls(movement.points[i], 0.5 * surroundings.image.voxel_mm(), evidence, evidence.log_likelihood[i]);
        }
    });
    if (beliefs.image_mm)
        for (const MovingPoint& p : movement.points) evidence.image_sd_mm.push_back(beliefs.image_mm(p.distance_mm));

    const auto across = static_cast<std::int64_t>(2 * examples.size()) * Appearance::kOffsets;
    const std::int64_t along = 2 * (Appearance::kHalf + evidence.most) + 1;
    movement.intensities = across + static_cast<std::int64_t>(movement.points.size()) * along;

    std::vector<double> distances;
    for (const MovingPoint& p : movement.points) distances.push_back(p.distance_mm);
    movement.prior.length_mm = std::max(kCorrelation * median(std::move(distances)), 2 * surroundings.image.voxel_mm());
    movement.offsets = find_offsets(movement.points, movement.prior, evidence, work);
    return movement;
}

}  // namespace kontur
