// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/click_guards.h"

#include <cmath>
#include <numbers>

#include "kontur/base/point_tree.h"
#include "kontur/bounds/clicks.h"

namespace kontur {
namespace {

constexpr int kDirections = 48;
constexpr double kRadii[] = {1.5, 2.5};  // of the click's distance from the lines, which turn the surface so far around
constexpr double kNearLine = 0.25;       // of the same: there the line holds the surface
constexpr double kNoise = 0.05;          // of the same
constexpr int kSteps = 4;
constexpr double kReached = 0.02;  // of the same: near enough to the surface

/// The n-th of so many directions, evenly spread.
Vec3 direction(int n) {
    const double z = 1 - (2 * n + 1) / static_cast<double>(kDirections), r = std::sqrt(1 - z * z);
    const double angle = n * std::numbers::pi * (3 - std::sqrt(5.0));
    return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Places around a click, brought to the surface; those that are not reached keep a value.
std::vector<Vec3> surface_around(const Vec3& click, double from_lines, const ImplicitFunction& function, const Work& work) {
    std::vector<Vec3> starts;
    for (const double radius : kRadii)
        for (int n = 0; n < kDirections; ++n) starts.push_back(click + radius * from_lines * direction(n));
    std::vector<Vec3> places = starts, gradients(places.size());
    std::vector<double> values(places.size());
    for (int step = 0; step < kSteps; ++step) {
        function.values_and_gradients(places, values, gradients, work);
        for (std::size_t i = 0; i < places.size(); ++i)
            places[i] -= values[i] / std::max(dot(gradients[i], gradients[i]), 0.1) * gradients[i];
    }
    function.values(places, values, work);
    std::vector<Vec3> bridges;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (std::abs(values[i]) < kReached * from_lines && distance(places[i], starts[i]) < from_lines)
            bridges.push_back(places[i]);
    return bridges;
}

}  // namespace

std::vector<Bound> click_guards(const PreparedContours& contours, const ImplicitFunction& without_clicks, const Work& work) {
    std::vector<Vec3> positions;
    for (const BoundaryPoint& p : contours.points) positions.push_back(p.position);
    const PointTree lines(std::move(positions));
    std::vector<Bound> guards;
    for (const Bound& click : contours.bounds) {
        if (!is_click(click)) continue;
        const double value = without_clicks.value(click.position);
        const bool is_outside = value > click.most_mm, is_inside = value < click.least_mm;
        if (!is_outside && !is_inside) continue;
        const double from_lines = lines.distance_to(click.position);
        for (const Vec3& place : surface_around(click.position, from_lines, without_clicks, work)) {
            if (lines.distance_to(place) < kNearLine * from_lines) continue;
            Bound& guard =
                guards.emplace_back(Bound{.position = place, .noise_mm = kNoise * from_lines, .extent = click.extent});
            (is_outside ? guard.most_mm : guard.least_mm) = 0;
        }
    }
    return guards;
}

}  // namespace kontur
