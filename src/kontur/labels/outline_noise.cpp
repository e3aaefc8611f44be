// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/outline_noise.h"

#include <algorithm>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/function/screened_kernel.h"
#include "kontur/labels/section_distances.h"

namespace kontur {
namespace {

constexpr double kShare = 0.05;

double half_thickness_mm(const PaintedObject& object) {
    double sum = 0;
    for (const PaintedSlice& slice : object.slices) {
        const std::vector<double> distances = section_distances(object.grid, slice);
        sum += std::max(0.0, *std::max_element(distances.begin(), distances.end()));
    }
    return sum / static_cast<double>(std::max<std::size_t>(object.slices.size(), 1));
}

double radius_mm(const ContourSet& contours) {
    std::vector<Vec3> points;
    for (const Contour& contour : contours.contours)
        points.insert(points.end(), contour.points.begin(), contour.points.end());
    return smallest_ball(points).radius;
}

}  // namespace

std::optional<double> outline_smoothing(const PaintedObject& object, const ContourSet& contours) {
    const double radius = radius_mm(contours);
    if (object.only_axis() < 0 || radius == 0) return {};
    const double noise = kShare * half_thickness_mm(object) / radius;
    return 9 * kScreeningLength * noise * noise;
}

}  // namespace kontur
