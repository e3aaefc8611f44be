// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/spread_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "kontur/extract/preview.h"

namespace kontur {
namespace {

/// Of each cell of a lattice that holds any, the first.
std::vector<Vec3> one_per_cell(std::span<const Vec3> points, const Vec3& corner, double edge_mm) {
    std::map<std::array<std::int64_t, 3>, std::size_t> first;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 at = (points[i] - corner) / edge_mm;
        const auto cell = [](double v) { return static_cast<std::int64_t>(std::floor(v)); };
        first.try_emplace({cell(at.x), cell(at.y), cell(at.z)}, i);
    }
    std::vector<Vec3> kept;
    for (const auto& entry : first) kept.push_back(points[entry.second]);
    return kept;
}

double side(const Contour& contour, std::size_t i) {
    return distance(contour.points[i], contour.points[(i + 1) % contour.points.size()]);
}

std::size_t sides(const Contour& contour) {
    const std::size_t points = contour.points.size();
    return contour.closed || points == 0 ? points : points - 1;
}

}  // namespace

std::vector<Vec3> points_of_surface(const ImplicitFunction& function, const ContourSet& contours, double spacing_mm,
                                    const Work& work) {
    std::vector<Vec3> starts;
    for (const Contour& contour : contours.contours)
        starts.insert(starts.end(), contour.points.begin(), contour.points.end());
    if (starts.empty()) return {};
    const Vec3 anchor = bounding_box(starts).min;  // so that the points move with the contours
    return preview_surface(function, starts, {.spacing_mm = spacing_mm, .anchor_mm = anchor}, work.untold()).points;
}

std::vector<Vec3> spread(const std::vector<Vec3>& points, std::size_t count) {
    if (points.size() <= count) return points;
    const Box3 box = bounding_box(points);
    double fine = 0, coarse = box.diagonal();
    std::vector<Vec3> kept;
    for (int halving = 0; halving < 12; ++halving) {
        const double edge = (fine + coarse) / 2;
        std::vector<Vec3> found = one_per_cell(points, box.min, edge);
        if (found.size() > count) {
            fine = edge;
        } else {
            coarse = edge;
            kept = std::move(found);
        }
    }
    return kept;
}

void slide_to_surface(const ImplicitFunction& function, std::vector<Vec3>& points, double reach_mm, const Work& work) {
    constexpr int kSteps = 3;
    constexpr double kLeastSlope2 = 0.09;
    std::vector<double> values(points.size());
    std::vector<Vec3> gradients(points.size());
    for (int step = 0; step < kSteps; ++step) {
        function.values_and_gradients(points, values, gradients, work);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3 move = -values[i] / std::max(dot(gradients[i], gradients[i]), kLeastSlope2) * gradients[i];
            const double far = norm(move);
            points[i] += (far > reach_mm ? reach_mm / far : 1.0) * move;
        }
    }
}

std::vector<MovingPoint> with_normals(const ImplicitFunction& function, std::span<const Vec3> points, const Work& work) {
    std::vector<Vec3> gradients(points.size());
    function.gradients(points, gradients, work);
    std::vector<MovingPoint> result(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) result[i] = {points[i], -normalized(gradients[i])};
    return result;
}

std::vector<Vec3> along_contours(const ContourSet& contours, double step_mm) {
    constexpr double kLeast = 8;
    std::vector<Vec3> points;
    for (const Contour& contour : contours.contours) {
        const double length = length_mm(contour);
        const double count = std::max(kLeast, std::round(length / step_mm));
        const double step = length / count;
        double next = 0, before = 0;
        for (std::size_t i = 0; i < sides(contour); ++i) {
            const Vec3 &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
            const double along = side(contour, i);
            for (; next < before + along; next += step) points.push_back(a + (next - before) / along * (b - a));
            before += along;
        }
    }
    return points;
}

double length_mm(const Contour& contour) {
    double sum = 0;
    for (std::size_t i = 0; i < sides(contour); ++i) sum += side(contour, i);
    return sum;
}

double length_mm(const ContourSet& contours) {
    double sum = 0;
    for (const Contour& contour : contours.contours) sum += length_mm(contour);
    return sum;
}

double nearest_distance(const Vec3& p, std::span<const Vec3> points) {
    double least2 = std::numeric_limits<double>::infinity();
    for (const Vec3& q : points) least2 = std::min(least2, dot(q - p, q - p));
    return std::sqrt(least2);
}

}  // namespace kontur
