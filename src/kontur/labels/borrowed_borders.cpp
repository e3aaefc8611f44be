// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/borrowed_borders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/labels/filled_map.h"
#include "kontur/labels/union_contours.h"

namespace kontur {
namespace {

// Of the distance to what was drawn of a structure: where its surface is farther away than that, it is not known to be
// there.
constexpr double kClose = 0.75;

/// How far places are from where f is 0, by Newton's method, without the fall far away, by which they would seem to be near.
std::vector<double> distances_mm(const ImplicitFunction& function, const std::vector<Vec3>& places_mm, const Work& work) {
    constexpr int kSteps = 4;
    std::vector<Vec3> at = places_mm, gradients(at.size());
    std::vector<double> values(at.size());
    for (int step = 0; step < kSteps; ++step) {
        function.values_and_gradients(at, values, gradients, work);
        const PointArrays places(function.frame().to_unit(at));
        std::vector<double> falls(at.size());
        function.add_fall(places, falls);
        for (std::size_t n = 0; n < at.size(); ++n) {
            const Vec3 slope = gradients[n] - function.fall_gradient_at(places[n]) / function.frame().scale;
            at[n] -= (values[n] - falls[n]) / std::max(dot(slope, slope), kRidgeSlope * kRidgeSlope) * slope;
        }
    }
    std::vector<double> result(at.size());
    for (std::size_t n = 0; n < at.size(); ++n) result[n] = distance(at[n], places_mm[n]);
    return result;
}

bool is_close(const Vec3& point, double distance_mm, const ContourSet& set) {
    double squared = std::numeric_limits<double>::infinity();
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) squared = std::min(squared, dot(p - point, p - point));
    return distance_mm < kClose * std::sqrt(squared);
}

struct Beside {
    std::size_t structure;
    double distance_mm;  ///< to its surface
};

/// What borders on the points of a contour of `owner`: for each the other structure whose surface is nearest, if that is
/// nearer than the union's.
std::vector<std::optional<Beside>> neighbours_at(const std::vector<Vec3>& points, std::size_t owner,
                                                 const Neighbours& neighbours, const Work& work) {
    std::vector<double> nearest = depths_mm(*neighbours.all, points, work);
    std::vector<std::optional<Beside>> result(points.size());
    for (std::size_t other = 0; other < neighbours.functions.size(); ++other) {
        if (other == owner) continue;
        const std::vector<double> distances = distances_mm(*neighbours.functions[other], points, work);
        for (std::size_t n = 0; n < points.size(); ++n)
            if (distances[n] < nearest[n]) nearest[n] = distances[n], result[n] = {other, distances[n]};
    }
    return result;
}

}  // namespace

std::vector<std::vector<SurfacePoint>> borrowed_borders(const Neighbours& neighbours, const Work& work) {
    std::vector<std::vector<SurfacePoint>> borrowed(neighbours.drawn.size());
    for (std::size_t owner = 0; owner < neighbours.drawn.size(); ++owner)
        for (const Contour& contour : neighbours.drawn[owner]->contours) {
            const auto is_silent = [&](std::size_t structure) {
                return !is_drawn_in(*neighbours.drawn[structure], contour.plane);
            };
            bool is_any_silent = false;
            for (std::size_t n = 0; n < neighbours.drawn.size(); ++n) is_any_silent = is_any_silent || is_silent(n);
            if (!is_any_silent) continue;
            const auto beside = neighbours_at(contour.points, owner, neighbours, work);
            for (std::size_t n = 0; n < beside.size(); ++n)
                if (beside[n] && is_silent(beside[n]->structure) &&
                    is_close(contour.points[n], beside[n]->distance_mm, *neighbours.drawn[beside[n]->structure]))
                    borrowed[beside[n]->structure].push_back({contour.points[n], {}});
        }
    return borrowed;
}

}  // namespace kontur
