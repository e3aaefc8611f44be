// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/contour_nesting.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "kontur/shape/box_tree.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// A contour by itself, and its box in its plane.
struct Outline {
    Section section;
    Box2 box;
};

Outline outline_of(const Contour& contour, const Plane& plane) {
    Outline outline{{plane, {Polygon2{}}, {}, {}}, {}};
    for (const Vec3& point : contour.points)
        outline.box.extend(outline.section.outlines.front().emplace_back(plane.to_uv(point)));
    return outline;
}

/// The closed contours of each plane, by whose plane it is.
std::map<std::size_t, std::vector<std::size_t>> closed_by_plane(const std::vector<Contour>& contours,
                                                                const std::vector<std::size_t>& plane) {
    std::map<std::size_t, std::vector<std::size_t>> of;
    for (std::size_t c = 0; c < contours.size(); ++c)
        if (contours[c].closed) of[plane[c]].push_back(c);
    return of;
}

enum class Position { outside, inside, crossing };

Position position_of(const Outline& outline, const SectionSearch& of_other, double tolerance) {
    constexpr std::size_t kMostTested = 2000;
    const Polygon2& points = outline.section.outlines.front();
    const std::size_t stride = 1 + points.size() / kMostTested;
    std::size_t inside = 0, outside = 0;
    for (std::size_t i = 0; i < points.size(); i += stride) ++(of_other.contains(points[i]) ? inside : outside);
    if (inside == 0) return Position::outside;
    inside = outside = 0;
    for (std::size_t i = 0; i < points.size(); i += stride)
        if (of_other.clearance(points[i]) > tolerance) ++(of_other.contains(points[i]) ? inside : outside);
    if ((inside == 0) == (outside == 0)) return Position::crossing;
    return inside == 0 ? Position::outside : Position::inside;
}

/// Whether the contours of a plane lie inside others of it, of those whose boxes meet.
void nest(const std::vector<std::size_t>& in_plane, const std::vector<Contour>& contours, const Plane& plane,
          double tolerance_mm, Nesting& nesting) {
    std::vector<Outline> outlines;
    std::vector<Box2> boxes;
    for (const std::size_t c : in_plane) {
        outlines.push_back(outline_of(contours[c], plane));
        boxes.push_back(outlines.back().box);
    }
    std::vector<SectionSearch> searches;
    searches.reserve(outlines.size());
    for (const Outline& outline : outlines) searches.emplace_back(outline.section);
    const BoxTree tree(std::move(boxes));
    for (std::size_t a = 0; a < in_plane.size(); ++a) {
        std::vector<std::size_t>& enclosing = nesting.enclosing[in_plane[a]];
        tree.visit_meeting(outlines[a].box, [&](std::size_t b) {
            if (a == b) return;
            const Position position = position_of(outlines[a], searches[b], tolerance_mm);
            if (position == Position::inside) enclosing.push_back(in_plane[b]);
            if (position == Position::crossing) nesting.crossings.emplace_back(std::minmax({in_plane[a], in_plane[b]}));
        });
        std::sort(enclosing.begin(), enclosing.end());
        nesting.depth[in_plane[a]] = enclosing.size();
    }
}

}  // namespace

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
        const auto group = std::find_if(planes.begin(), planes.end(), [&](std::size_t other) {
            return lies_in(contours[c], contours[other].plane, tolerance_mm);
        });
        plane_of[c] = group == planes.end() ? planes.emplace_back(c) : *group;
    }
    return plane_of;
}

Nesting find_nesting(const std::vector<Contour>& contours, double tolerance_mm) {
    Nesting nesting;
    nesting.depth.assign(contours.size(), 0);
    nesting.enclosing.resize(contours.size());
    for (const auto& [plane, in_plane] : closed_by_plane(contours, shared_planes(contours, tolerance_mm)))
        nest(in_plane, contours, contours[plane].plane, tolerance_mm, nesting);
    std::sort(nesting.crossings.begin(), nesting.crossings.end());
    nesting.crossings.erase(std::unique(nesting.crossings.begin(), nesting.crossings.end()), nesting.crossings.end());
    return nesting;
}

}  // namespace kontur
