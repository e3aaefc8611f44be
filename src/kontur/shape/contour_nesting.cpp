// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/contour_nesting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// A contour by itself, and its box in its plane.
struct Outline {
    Section section;
    Point2 low, high;
};

Outline outline_of(const Contour& contour, const Plane& plane) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Outline outline{{plane, {Polygon2{}}, {}, {}}, {kFar, kFar}, {-kFar, -kFar}};
    for (const Vec3& point : contour.points) {
        const Point2& p = outline.section.outlines.front().emplace_back(plane.to_uv(point));
        for (std::size_t axis = 0; axis < 2; ++axis) {
            outline.low[axis] = std::min(outline.low[axis], p[axis]);
            outline.high[axis] = std::max(outline.high[axis], p[axis]);
        }
    }
    return outline;
}

bool boxes_meet(const Outline& a, const Outline& b) {
    return a.low[0] <= b.high[0] && b.low[0] <= a.high[0] && a.low[1] <= b.high[1] && b.low[1] <= a.high[1];
}

enum class Position { outside, inside, crossing };

Position position_of(const Outline& outline, const Outline& other, const SectionSearch& of_other, double tolerance) {
    if (!boxes_meet(outline, other)) return Position::outside;
    constexpr std::size_t kMostTested = 2000;
    const Polygon2& points = outline.section.outlines.front();
    const std::size_t stride = 1 + points.size() / kMostTested;
    std::size_t inside = 0, outside = 0;
    for (std::size_t i = 0; i < points.size(); i += stride) ++(of_other.contains(points[i]) ? inside : outside);
    if (inside == 0) return Position::outside;
    inside = outside = 0;
    for (std::size_t i = 0; i < points.size(); i += stride)
        if (of_other.clearance(points[i]) > tolerance) ++(of_other.contains(points[i]) ? inside : outside);
    return inside == 0 ? Position::outside : outside == 0 ? Position::inside : Position::crossing;
}

}  // namespace

std::string_view name(FillRule rule) noexcept { return rule == FillRule::even_odd ? "even-odd" : "declared"; }

FillChanges apply_fill_rule(ContourSet& set, FillRule rule) {
    std::vector<Contour>& contours = set.contours;
    const Nesting nesting = find_nesting(contours, kSamePlane * diameter_mm(set));
    FillChanges changes;
    changes.crossings = nesting.crossings;
    if (rule == FillRule::even_odd) {
        for (std::size_t i = 0; i < contours.size(); ++i) {
            const bool nested = nesting.depth[i] % 2 == 1;
            if (!nested && contours[i].hole) changes.stray_holes.push_back(i);
            if (!nested || contours[i].hole) continue;
            contours[i].hole = true;
            ++changes.holes;
        }
        return changes;
    }
    std::vector<Contour> kept;
    for (std::size_t i = 0; i < contours.size(); ++i) {
        int layers = 0;
        for (const std::size_t around : nesting.enclosing[i]) layers += contours[around].hole ? -1 : 1;
        if (layers <= 0 && contours[i].hole) changes.stray_holes.push_back(i);
        if (layers <= 0 || contours[i].hole) kept.push_back(contours[i]);
    }
    changes.removed = contours.size() - kept.size();
    contours = std::move(kept);
    return changes;
}

bool lies_in(const Contour& contour, const Plane& plane, double tolerance_mm) {
    constexpr double kAcross = 0.95;  // a tiny contour may lie near any plane
    return std::abs(dot(contour.plane.normal, plane.normal)) > kAcross &&
           std::all_of(contour.points.begin(), contour.points.end(),
                       [&](const Vec3& p) { return std::abs(plane.distance_to(p)) <= tolerance_mm; });
}

std::vector<std::size_t> largest_first(const std::vector<Contour>& contours) {
    std::vector<double> size(contours.size());
    std::transform(contours.begin(), contours.end(), size.begin(),
                   [](const Contour& contour) { return bounding_box(contour.points).diagonal(); });
    std::vector<std::size_t> order(contours.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
    return order;
}

std::vector<std::size_t> shared_planes(const std::vector<Contour>& contours, double tolerance_mm) {
    std::vector<std::size_t> planes, plane_of(contours.size());
    for (const std::size_t c : largest_first(contours)) {
        const auto found = std::find_if(planes.begin(), planes.end(), [&](std::size_t other) {
            return lies_in(contours[c], contours[other].plane, tolerance_mm);
        });
        plane_of[c] = found == planes.end() ? planes.emplace_back(c) : *found;
    }
    return plane_of;
}

Nesting find_nesting(const std::vector<Contour>& contours, double tolerance_mm) {
    const std::vector<std::size_t> plane = shared_planes(contours, tolerance_mm);
    std::vector<Outline> outlines;
    for (std::size_t i = 0; i < contours.size(); ++i) outlines.push_back(outline_of(contours[i], contours[plane[i]].plane));
    std::vector<SectionSearch> searches;
    searches.reserve(outlines.size());
    for (const Outline& outline : outlines) searches.emplace_back(outline.section);
    Nesting nesting;
    nesting.depth.assign(contours.size(), 0);
    nesting.enclosing.resize(contours.size());
    for (std::size_t a = 0; a < contours.size(); ++a)
        for (std::size_t b = 0; b < contours.size(); ++b) {
            if (a == b || plane[a] != plane[b] || !contours[a].closed || !contours[b].closed) continue;
            const Position position = position_of(outlines[a], outlines[b], searches[b], tolerance_mm);
            if (position == Position::inside) {
                ++nesting.depth[a];
                nesting.enclosing[a].push_back(b);
            }
            if (position == Position::crossing) nesting.crossings.emplace_back(std::min(a, b), std::max(a, b));
        }
    std::sort(nesting.crossings.begin(), nesting.crossings.end());
    nesting.crossings.erase(std::unique(nesting.crossings.begin(), nesting.crossings.end()), nesting.crossings.end());
    return nesting;
}

}  // namespace kontur
