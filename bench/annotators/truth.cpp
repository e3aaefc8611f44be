// SPDX-License-Identifier: Apache-2.0
#include "truth.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "kontur/base/smallest_ball.h"
#include "kontur/extract/trace.h"
#include "kontur/io/image.h"

namespace kontur {
namespace {

constexpr double kUnsteadyMm = 0.55;  // rms, as bench/hands.py's wave
constexpr int kWaves = 5;

double length_mm(const std::vector<Vec3>& points) {
    double sum = 0;
    for (std::size_t n = 0; n < points.size(); ++n) sum += distance(points[n], points[(n + 1) % points.size()]);
    return sum;
}

/// Long waves along the contour's normal; tiny contours are displaced less. The same plane is drawn in the same way again.
void tremble(Contour& contour, std::mt19937& random) {
    std::normal_distribution<double> normal;
    const std::vector<Vec3> points = contour.points;
    const double perimeter = length_mm(points);
    double harmonics = 0;
    for (int wave = 1; wave <= kWaves; ++wave) harmonics += 1.0 / wave;
    const double rms = std::min(kUnsteadyMm, perimeter / 40) / std::sqrt(harmonics);
    std::array<std::array<double, 2>, kWaves> heights;
    for (int wave = 0; wave < kWaves; ++wave)
        for (double& height : heights[wave]) height = normal(random) * rms / std::sqrt(wave + 1.0);
    double along = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
        const Vec3 &before = points[(n + points.size() - 1) % points.size()], &after = points[(n + 1) % points.size()];
        const double angle = 2 * std::numbers::pi * along / perimeter;
        double height = 0;
        for (int wave = 0; wave < kWaves; ++wave)
            height += heights[wave][0] * std::cos((wave + 1) * angle) + heights[wave][1] * std::sin((wave + 1) * angle);
        contour.points[n] += height * normalized(cross(after - before, contour.plane.normal));
        along += distance(points[n], after);
    }
}

}  // namespace

Truth::Truth(const std::filesystem::path& folder, Hand hand)
    : name_(folder.filename().string()),
      hand_(hand),
      fine_(read_mask(folder / "fine.nii.gz")),
      border_(points_on_faces(fine_, 1)),
      distance_(read_image(folder / "distance.nii.gz")),
      to_index_(distance_.grid.index_to_mm.inverse()) {
    if (const std::filesystem::path image = folder / "image.nii.gz"; exists(image)) image_ = read_image(image);
    std::vector<Vec3> border;
    Vec3 sum;
    const Grid& g = grid();
    for (std::int64_t k = 0; k < g.size.k; ++k)
        for (std::int64_t j = 0; j < g.size.j; ++j)
            for (std::int64_t i = 0; i < g.size.i; ++i) {
                const double depth = sample(distance_, g.offset(i, j, k));
                if (!(depth > 0)) continue;
                const Vec3 at = g.center_mm(i, j, k);
                if (depth < cube_mm()) border.push_back(at);
                box_.extend(at);
                sum += at;
                places_.push_back(at);
            }
    centroid_ = sum / static_cast<double>(places_.size());
    volume_mm3_ = static_cast<double>(places_.size()) * g.voxel_volume_mm3();
    diameter_mm_ = smallest_ball(border).diameter();
}

double Truth::distance_at(const Vec3& p) const { return interpolate(distance_, to_index_, p, -diameter_mm_); }

double Truth::dice(const Mask& mask) const {
    std::int64_t both = 0, sum = 0;
    for (std::size_t n = 0; n < mask.values.size(); ++n) {
        const bool truly = sample(distance_, n) > 0, found = mask.values[n] != 0;
        both += truly && found;
        sum += truly + found;
    }
    return 2.0 * static_cast<double>(both) / static_cast<double>(sum);
}

std::vector<Contour> Truth::draw(const Plane& plane) const {
    const double cube = cube_mm();
    TraceOptions options;
    options.step_mm = 0.4 * cube;
    options.tolerance_mm = 0.2 * cube;
    options.min_area_mm2 = 12 * cube * cube;
    std::vector<Contour> contours = trace(fine_, std::span(&plane, 1), options, {.threads = 1}).contours;
    if (hand_ == Hand::unsteady) {
        const Vec3& n = plane.normal;
        const long long seed = std::llround(1e3 * (dot(plane.origin, n) + 7 * n.x + 13 * n.y + 29 * n.z));
        std::mt19937 random(static_cast<std::uint32_t>(std::hash<long long>()(seed)));
        for (Contour& contour : contours) tremble(contour, random);
    }
    return contours;
}

}  // namespace kontur
