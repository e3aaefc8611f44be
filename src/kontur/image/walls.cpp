// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/walls.h"

#include <algorithm>
#include <cmath>

#include "kontur/drawing/drawn_planes.h"
#include "kontur/sampling/quantile.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

constexpr double kEndGaps = 0.6;        // beyond the last plane of a stack
constexpr double kTouching = 1 + 1e-6;  // planes between two layers of cells are in both, however they are rounded
constexpr double kGrazing = 0.05;       // cosine: a path flatter than this against a plane does not meet it

/// Closed planes: all contours of a section's plane are closed.
std::vector<Plane> complete_planes(const Drawing& drawing) {
    const std::vector<Contour>& contours = drawing.contours.contours;
    std::vector<Plane> planes;
    for (const Section& section : DrawnPlanes(drawing.contours, drawing.ball).sections) {
        const bool complete = std::none_of(contours.begin(), contours.end(), [&](const Contour& c) {
            return !c.closed && lies_in(c, section.plane, kSamePlane * drawing.diameter_mm());
        });
        if (complete) planes.push_back(section.plane);
    }
    return planes;
}

}  // namespace

Walls::Walls(const Drawing& drawing) : planes_(complete_planes(drawing)) {
    if (planes_.size() < 2) return;
    const Vec3 along = planes_.front().normal;
    std::vector<double> heights;
    for (const Plane& plane : planes_) {
        if (!are_parallel(plane, planes_.front())) return;
        heights.push_back(dot(along, plane.origin));
    }
    std::sort(heights.begin(), heights.end());
    std::vector<double> gaps;
    for (std::size_t i = 1; i < heights.size(); ++i) gaps.push_back(heights[i] - heights[i - 1]);
    const double room = kEndGaps * median(std::move(gaps));
    ends_ = {{along, heights.back() + room}, {-along, room - heights.front()}};
}

void Walls::limit(std::span<MovingPoint> points) const {
    for (MovingPoint& point : points) {
        for (const Plane& plane : planes_) {
            const double slant = dot(plane.normal, point.normal);
            if (std::abs(slant) <= kGrazing) continue;
            const double u = -plane.distance_to(point.position) / slant;
            if (u > 0) point.most_mm = std::min(point.most_mm, u);
            if (u < 0) point.least_mm = std::max(point.least_mm, u);
        }
        for (const EndWall& end : ends_) {
            const double slant = dot(end.direction, point.normal);
            if (slant <= kGrazing) continue;
            const double room = std::max(end.height_mm - dot(end.direction, point.position), 0.0);
            point.most_mm = std::min(point.most_mm, room / slant);
        }
    }
}

bool Walls::is_in_plane(const Vec3& point, std::span<const Vec3> half_edges) const {
    return std::any_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
        double reach = 0;
        for (const Vec3& half : half_edges) reach += std::abs(dot(plane.normal, half));
        return std::abs(plane.distance_to(point)) <= kTouching * reach;
    });
}

bool Walls::is_beyond_end(const Vec3& point) const {
    return std::any_of(ends_.begin(), ends_.end(),
                       [&](const EndWall& end) { return dot(end.direction, point) > end.height_mm; });
}

}  // namespace kontur
