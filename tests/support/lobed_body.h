// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>

#include "kontur/base/parallel.h"
#include "kontur/extract/preview.h"
#include "kontur/extract/trace.h"
#include "kontur/image/follow_image.h"
#include "kontur/phantom/random.h"
#include "kontur/pipeline.h"

namespace kontur::test {

/// Positive inside a body of radius 30 mm with lobes and hollows of 7 mm in places where planes across the axes show but
/// their feet.
inline double lobed_depth(const Vec3& p) {
    const double r = norm(p) + 1e-9;
    double radius = 30;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) {
                const Vec3 apart = p / r - Vec3{0.6 * x, 0.5 * y, 0.62 * z};
                radius += 7 * x * y * z * std::exp(-dot(apart, apart) / (2 * 0.3 * 0.3));
            }
    return radius - r;
}

/// First-order distance to the surface of a body that is positive inside.
inline double surface_distance(const std::function<double(const Vec3&)>& depth, const Vec3& p) {
    constexpr double h = 1e-3;
    const Vec3 gradient{depth(p + Vec3{h, 0, 0}) - depth(p - Vec3{h, 0, 0}),
                        depth(p + Vec3{0, h, 0}) - depth(p - Vec3{0, h, 0}),
                        depth(p + Vec3{0, 0, h}) - depth(p - Vec3{0, 0, h})};
    return std::abs(depth(p)) / (norm(gradient) / (2 * h));
}

/// Intensities as a function of the place, mm.
using Look = std::function<double(const Vec3&)>;

/// 100 inside, 20 outside, blurred over a voxel or two.
inline double two_tissues(double depth_mm) { return 60 + 40 * std::tanh(depth_mm / 1.5); }

inline double body_look(const Vec3& p) { return two_tissues(lobed_depth(p)); }

/// Independent from voxel to voxel, mean 0, variance 1.
inline double white_noise(std::int64_t index) {
    Random random(static_cast<std::uint64_t>(index) * 7919 + 13);
    return random.gaussian();
}

inline Grid cube_grid(double spacing_mm, double half_mm = 48) {
    return grid_around({{-half_mm, -half_mm, -half_mm}, {half_mm, half_mm, half_mm}}, {spacing_mm, spacing_mm, spacing_mm},
                       0);
}

inline Image image_of(const Grid& grid, const Look& look, double noise = 0) {
    std::vector<float> samples(static_cast<std::size_t>(grid.voxel_count()));
    parallel_for(grid.size.k, 1, 0, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                for (std::int64_t i = 0; i < grid.size.i; ++i) {
                    const std::size_t at = grid.offset(i, j, k);
                    const double grain = noise > 0 ? noise * white_noise(static_cast<std::int64_t>(at)) : 0;
                    samples[at] = static_cast<float>(look(grid.center_mm(i, j, k)) + grain);
                }
    });
    return {grid, std::move(samples)};
}

/// Contours of the body, cut from fine voxels; within a twentieth of a mm of it.
inline ContourSet drawn_on(const std::vector<Plane>& planes, const std::function<double(const Vec3&)>& depth = lobed_depth) {
    ContourSet set;
    for (const Plane& plane : planes) {
        Contour contour{.plane = plane, .points = {}};
        // The body is star-shaped about every place near its middle: one radius for each direction in the plane.
        const Vec3 middle = plane.origin;
        for (int n = 0; n < 90; ++n) {
            const double angle = 2 * M_PI * n / 90;
            const Vec3 direction = std::cos(angle) * plane.u + std::sin(angle) * plane.v;
            double low = 0, high = 60;
            for (int halving = 0; halving < 40; ++halving) {
                const double at = (low + high) / 2;
                (depth(middle + at * direction) > 0 ? low : high) = at;
            }
            contour.points.push_back(middle + low * direction);
        }
        set.contours.push_back(std::move(contour));
    }
    return set;
}

/// Two planes across z, one across x and y each.
inline std::vector<Plane> orthogonal_planes() {
    return {make_plane({0, 0, -8}, {0, 0, 1}), make_plane({0, 0, 5}, {0, 0, 1}), make_plane({4, 0, 0}, {1, 0, 0}),
            make_plane({0, -3, 0}, {0, 1, 0})};
}

inline std::vector<Plane> stacked_planes() {
    std::vector<Plane> planes;
    for (const double z : {-21.0, -11.0, 0.0, 10.0, 20.0}) planes.push_back(make_plane({0, 0, z}, {0, 0, 1}));
    return planes;
}

/// What `segment` does up to the function.
struct FollowedImage {
    Drawing drawing;
    FittedFunction plain;
    ImageFit with_image;
};

inline FollowedImage follow_image_of(const ContourSet& contours, const Image& image, int threads = 0) {
    const Work work{.threads = threads};
    Drawing drawing = read_drawing(contours, FillRule::even_odd);
    StageOptions stages = stage_options({}, drawing.diameter_mm());
    const PreparedContours prepared = prepare(drawing, stages.prepare, work);
    FittedFunction plain = fit(prepared, stages.fit, work);
    const auto fit_part = [&](const ContourSet& part) { return fit_coarsely(part, stages, {.threads = 1}); };
    ImageFit with_image = follow_image({drawing, prepared, plain}, image, fit_part, {.fit = stages.fit}, work);
    return {std::move(drawing), std::move(plain), std::move(with_image)};
}

/// Points of the surface of f.
inline std::vector<Vec3> surface_points(const ImplicitFunction& function, const ContourSet& contours) {
    std::vector<Vec3> starts;
    for (const Contour& contour : contours.contours)
        starts.insert(starts.end(), contour.points.begin(), contour.points.end());
    return preview_surface(function, starts, {.spacing_mm = 2}).points;
}

/// Mean distance of the surface of f from the body's, mm.
inline double surface_error(const ImplicitFunction& function, const ContourSet& contours,
                            const std::function<double(const Vec3&)>& depth = lobed_depth) {
    const std::vector<Vec3> points = surface_points(function, contours);
    double sum = 0;
    for (const Vec3& p : points) sum += surface_distance(depth, p);
    return sum / static_cast<double>(points.size());
}

}  // namespace kontur::test
