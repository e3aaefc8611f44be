// SPDX-License-Identifier: Apache-2.0
#include "true_tilts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "kontur/extract/track.h"
#include "kontur/extract/voxelize.h"
#include "kontur/fit/fit.h"
#include "kontur/fit/prepare.h"
#include "kontur/pipeline.h"

namespace kontur {
namespace {

constexpr double kReach = 3.5;              // of the Gaussian, in its standard deviations
constexpr std::size_t kMostLookedAt = 300;  // points tell the mean angles

/// The voxels along an axis whose centres are within reach of `at`.
std::pair<std::int64_t, std::int64_t> within(double at, double reach, std::int64_t size) {
    const auto voxel = [&](double v) { return std::clamp(static_cast<std::int64_t>(v), std::int64_t{0}, size); };
    return {voxel(std::ceil(at - reach)), voxel(std::floor(at + reach) + 1)};
}

/// Minus the gradient of the blurred mask, up to a factor. What voxels of either kind there are around `p` has no say: their
/// centres lie unevenly, and a grid may end.
Vec3 blurred_descent(const Mask& mask, const Affine3& mm_to_index, const Vec3& p, double sigma_mm) {
    const Grid& grid = mask.grid;
    const Vec3 at = mm_to_index.apply(p), spacing = grid.spacing_mm();
    std::array<std::pair<std::int64_t, std::int64_t>, 3> range;
    for (int axis = 0; axis < 3; ++axis)
        range[static_cast<std::size_t>(axis)] = within(at[axis], kReach * sigma_mm / spacing[axis], grid.size[axis]);
    Vec3 inside{}, all{};
    double weight_inside = 0, weight = 0;
    for (std::int64_t k = range[2].first; k < range[2].second; ++k)
        for (std::int64_t j = range[1].first; j < range[1].second; ++j)
            for (std::int64_t i = range[0].first; i < range[0].second; ++i) {
                const Vec3 d = grid.center_mm(i, j, k) - p;
                const double w = std::exp(-dot(d, d) / (2 * sigma_mm * sigma_mm));
                weight += w;
                all += w * d;
                if (mask.values[grid.offset(i, j, k)] == 0) continue;
                weight_inside += w;
                inside += w * d;
            }
    return weight > 0 ? (weight_inside / weight) * all - inside : Vec3{};
}

/// Cosines of the true surface's tilt, bounded as the fit bounds its own.
std::vector<double> true_slopes(const NormalAt& normal, const std::vector<BoundaryPoint>& points) {
    std::vector<double> slopes;
    for (const BoundaryPoint& point : points) {
        const Vec3 n = normal(point.position);
        const double inplane = dot(n, point.inplane_normal), whole = std::hypot(inplane, dot(n, point.plane_normal));
        slopes.push_back(std::clamp(whole > 0 ? inplane / whole : 1.0, FitOptions{}.least_slope, 1.0));
    }
    return slopes;
}

/// 0 where either has no direction.
double degrees_between(const Vec3& a, const Vec3& b) {
    const double lengths = norm(a) * norm(b);
    return lengths > 0 ? std::acos(std::clamp(dot(a, b) / lengths, -1.0, 1.0)) * 180 / std::numbers::pi : 0;
}

}  // namespace

NormalAt blurred_normal(const Mask& mask, double sigma_voxels) {
    const double sigma_mm = sigma_voxels * std::cbrt(mask.grid.voxel_volume_mm3());
    return [&mask, sigma_mm, mm_to_index = mask.grid.index_to_mm.inverse()](const Vec3& p) {
        return normalized(blurred_descent(mask, mm_to_index, p, sigma_mm));
    };
}

TrueTiltsFit segment_with_true_tilts(const ContourSet& contours, const Grid& grid, const NormalAt& normal) {
    const Drawing drawing(contours);
    StageOptions stages = stage_options({}, drawing.diameter_mm());
    const PreparedContours prepared = prepare(drawing, stages.prepare);
    stages.fit.rounds = 0;
    stages.fit.start_slopes = true_slopes(normal, prepared.points);
    ImplicitFunction function = fit(prepared, stages.fit).function;
    Mask mask = fill(track_surface(function, grid, start_points(contours, prepared, function, 0)));
    return {std::move(function), std::move(mask)};
}

NormalErrors normal_errors(const ContourSet& contours, const Mask& truth, const ImplicitFunction& function) {
    const Drawing drawing(contours);
    const PreparedContours prepared = prepare(drawing);
    const NormalAt normal = blurred_normal(truth, kBlurVoxels), blurred_more = blurred_normal(truth, kMoreBlurVoxels);
    NormalErrors sum;
    double count = 0;
    for (std::size_t i = 0; i < prepared.points.size(); i += prepared.points.size() / kMostLookedAt + 1, ++count) {
        const BoundaryPoint& point = prepared.points[i];
        const auto in_plane = [&](const Vec3& v) { return v - dot(v, point.plane_normal) * point.plane_normal; };
        const Vec3 of_truth = normal(point.position), of_function = -function.gradient(point.position);
        sum.all += degrees_between(of_truth, of_function);
        sum.in_plane += degrees_between(in_plane(of_truth), in_plane(of_function));
        sum.truth += degrees_between(of_truth, blurred_more(point.position));
    }
    count = std::max(count, 1.0);
    return {sum.all / count, sum.in_plane / count, sum.truth / count};
}

}  // namespace kontur
