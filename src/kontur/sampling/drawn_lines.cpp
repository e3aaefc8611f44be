// SPDX-License-Identifier: Apache-2.0
#include "kontur/sampling/drawn_lines.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/parallel.h"
#include "kontur/base/point_tree.h"

namespace kontur {
namespace {

constexpr double kStep = 0.004;               // of the diameter, between the points of a line
constexpr double kSamePlaneCosine = 0.99939;  // 2 degrees
constexpr double kSamePlaneDistance = 0.005;  // of the diameter
constexpr std::int64_t kPointsPerChunk = 256;

Vec3 middle_of(const Contour& contour) {
    Vec3 sum;
    for (const Vec3& p : contour.points) sum += p;
    return sum / static_cast<double>(contour.points.size());
}

double length_mm(const Contour& contour) {
    double length = 0;
    for (std::size_t n = 1; n < contour.points.size(); ++n) length += distance(contour.points[n - 1], contour.points[n]);
    return contour.closed ? length + distance(contour.points.back(), contour.points.front()) : length;
}

bool is_same(const Plane& other, const Plane& plane, double distance_mm) {
    return std::abs(dot(other.normal, plane.normal)) > kSamePlaneCosine &&
           std::abs(other.distance_to(plane.origin)) < distance_mm;
}

}  // namespace

std::vector<Vec3> dense_points(const Contour& contour, double step_mm) {
    constexpr double kMostParts = 1e6;
    std::vector<Vec3> dense;
    const std::size_t count = contour.points.size(), edges = contour.closed ? count : count - (count > 0);
    for (std::size_t n = 0; n < edges; ++n) {
        const Vec3 &from = contour.points[n], &to = contour.points[(n + 1) % count];
        const double parts = std::clamp(std::ceil(distance(from, to) / step_mm), 1.0, kMostParts);
        for (double part = 0; part < parts; ++part) dense.push_back(from + part / parts * (to - from));
    }
    if (!contour.closed && count > 0) dense.push_back(contour.points.back());
    return dense;
}

DrawnLines::DrawnLines(const ContourSet& contours) {
    const double diameter = diameter_mm(contours);
    std::vector<Vec3> points;
    for (const Contour& contour : contours.contours) {
        if (contour.points.empty()) continue;
        const std::vector<Vec3> dense = dense_points(contour, kStep * diameter);
        points.insert(points.end(), dense.begin(), dense.end());
        Plane plane = contour.plane;
        plane.origin = middle_of(contour);
        const auto same = [&](const Plane& other) { return is_same(other, plane, kSamePlaneDistance * diameter); };
        const auto at = static_cast<std::size_t>(std::find_if(planes_.begin(), planes_.end(), same) - planes_.begin());
        if (at == planes_.size()) {
            planes_.push_back(plane);
            lengths_mm_.push_back(0);
        }
        lengths_mm_[at] += length_mm(contour);
    }
    for (const SurfacePoint& point : contours.surface) points.push_back(point.position);
    tree_ = std::make_shared<const PointTree>(std::move(points));
}

double DrawnLines::distance_to(const Vec3& p) const noexcept { return tree_->distance_to(p); }

std::vector<double> DrawnLines::distances_to(const std::vector<Vec3>& points, const Work& work) const {
    std::vector<double> distances(points.size());
    parallel_for(static_cast<std::int64_t>(points.size()), kPointsPerChunk, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            distances[n] = tree_->distance_to(points[n]);
    });
    return distances;
}

}  // namespace kontur
