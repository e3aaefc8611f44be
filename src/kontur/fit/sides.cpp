// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/sides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/drawing/orient.h"
#include "kontur/drawing/reconcile.h"
#include "kontur/drawing/subdivide.h"
#include "kontur/fit/constraints.h"
#include "kontur/solve/solve.h"

namespace kontur {
namespace {

/// Points of the closed contours and single points of the surface.
std::vector<BoundaryPoint> known_points(const ContourSet& set) {
    std::vector<BoundaryPoint> points;
    for (const Contour& line : set.contours) {
        if (!line.closed) continue;
        const Contour contour = subdivide(line, kLeastSegments);
        const std::vector<Vec3> normals = orient(contour).normals;
        for (std::size_t i = 0; i < normals.size(); ++i)
            points.push_back({contour.points[i], normals[i], contour.plane.normal, kNoContour, contour.weight});
    }
    for (const SurfacePoint& p : set.surface)
        points.push_back({.position = p.position, .inplane_normal = p.outward.value_or(Vec3{}), .contour = kNoContour});
    return points;
}

/// A coarse interpolant of what is known and of the positions of the open contours; nothing when that does not suffice.
std::optional<ImplicitFunction> coarse_fit(const ContourSet& set) {
    std::vector<BoundaryPoint> points = known_points(set);
    if (points.empty() && set.interior.empty() && set.exterior.empty()) return std::nullopt;
    for (const Contour& contour : set.contours)
        if (!contour.closed && !contour.inside)
            for (const Vec3& p : contour.points) points.push_back({.position = p, .contour = kNoContour});

    const double diameter = diameter_mm(set);
    std::vector<PointConstraint> clicks;
    for (const Vec3& p : set.interior) clicks.push_back({p, 0.075 * diameter});
    for (const Vec3& p : set.exterior) clicks.push_back({p, -0.075 * diameter});
    const PlaceOptions place{.normal_offset_mm = kMarginFraction * diameter, .merge_distance_mm = 1.5e-3 * diameter};
    try {
        const std::vector<double> slopes(points.size(), 1.0);
        return solve(place_constraints(points, slopes, clicks, place).constraints,
                     {.smoothing = 1e-3, .tolerance_mm = 1.5e-3 * diameter})
            .function;
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::singular_system && error.kind() != ErrorKind::invalid_input) throw;
        return std::nullopt;
    }
}

Vec3 middle_of(const ContourSet& set) {
    Vec3 sum;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) sum += p;
    return sum / static_cast<double>(point_count(set));
}

/// How surely the object lies to the left of the contour: from 1 to -1, surely to the right.
double leftness(const Contour& contour, const std::optional<ImplicitFunction>& coarse, const Vec3& middle) {
    const std::vector<Vec3> normals = left_normals(contour);
    double sum = 0, total = 0;
    for (std::size_t i = 0; i < contour.points.size(); ++i) {
        const Vec3 inward = coarse ? coarse->gradient(contour.points[i]) : middle - contour.points[i];
        sum += dot(inward, normals[i]);
        total += norm(inward);
    }
    return total > 0 ? sum / total : 0;
}

}  // namespace

std::vector<FoundSide> find_sides(ContourSet& set) {
    std::vector<FoundSide> sides;
    std::optional<ImplicitFunction> coarse;
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        Contour& contour = set.contours[c];
        if (contour.closed || contour.inside) continue;
        if (sides.empty()) coarse = coarse_fit(set);
        constexpr double kSure = 0.3;
        const double leftward = leftness(contour, coarse, middle_of(set));
        const Hand hand = leftward > 0 ? Hand::left : Hand::right;
        sides.push_back({c, hand, std::abs(leftward) >= kSure});
        contour.inside = hand;
    }
    return sides;
}

Drawing read_drawing(const ContourSet& set, FillRule rule) {
    Drawing drawing(set, rule);
    drawing.sides = find_sides(drawing.tidied);
    for (std::string& sentence : sentences(drawing.sides)) drawing.notes.push_back(std::move(sentence));
    return drawing;
}

std::vector<std::string> sentences(const std::vector<FoundSide>& sides) {
    std::vector<std::string> all;
    for (const bool is_sure : {true, false})
        for (const Hand inside : {Hand::left, Hand::right}) {
            std::vector<FoundSide> alike;
            std::ranges::copy_if(sides, std::back_inserter(alike),
                                 [&](const FoundSide& side) { return side.inside == inside && side.is_sure == is_sure; });
            if (alike.empty()) continue;
            const std::size_t first = alike.front().contour + 1;
            all.push_back(
                (alike.size() == 1
                     ? fmt::format("contour {} is open; the object was taken to lie on its {}", first, name(inside))
                     : fmt::format("{} contours are open, the first of them contour {}; the object was "
                                   "taken to lie on their {}",
                                   alike.size(), first, name(inside))) +
                (is_sure ? "" : ", which is doubtful"));
        }
    return all;
}

}  // namespace kontur
