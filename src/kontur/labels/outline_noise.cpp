// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/outline_noise.h"

#include <algorithm>
#include <vector>

#include "kontur/function/smoothing_of_noise.h"
#include "kontur/labels/section_distances.h"

namespace kontur {
namespace {

constexpr double kShare = 0.05;

}  // namespace

double half_thickness_mm(const PaintedObject& object) {
    double sum = 0;
    for (const PaintedSlice& slice : object.slices) {
        const std::vector<double> distances = section_distances(object.grid, slice);
        sum += std::max(0.0, *std::max_element(distances.begin(), distances.end()));
    }
    return sum / static_cast<double>(std::max<std::size_t>(object.slices.size(), 1));
}

std::optional<double> outline_smoothing(const PaintedObject& object, const ContourSet& contours) {
    const double radius = smallest_ball(contours).radius;
    if (object.only_axis() < 0 || radius == 0) return {};
    return smoothing_of_noise(kShare * half_thickness_mm(object) / radius);
}

}  // namespace kontur
