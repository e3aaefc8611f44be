// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/refit.h"

#include <algorithm>
#include <cmath>

#include "kontur/fit/constraints.h"

namespace kontur {
namespace {

constexpr std::size_t kCompared = 500;  // drawn points at which functions are

}  // namespace

FittedFunction Refit::with(const std::vector<PointConstraint>& more, const Work& work) {
    std::vector<PointConstraint> single = fitted_.held;
    single.insert(single.end(), more.begin(), more.end());
    PlacedConstraints placed = place_constraints(prepared_.points, fitted_.slopes, single, options_.place);
    hold_contours(placed.constraints);
    FittedFunction result = fitted_;
    solve_placed(placed, options_.solve, prepared_.ball, work, previous_, result);
    return result;
}

/// Points that yield where contours contradict each other yield to those, and not to the image: f stays there what it was.
void Refit::hold_contours(ConstraintSet& constraints) const {
    std::size_t place = 0;
    for (const BoundaryPoint& point : prepared_.points) {
        if (place == constraints.size() || constraints.centers[place] != point.position) continue;  // merged
        if (point.trust < 1) {
            constraints.values[place] = fitted_.function.value(point.position);
            constraints.trust[place] = 1;
        }
        ++place;
    }
}

double largest_change(const ImplicitFunction& a, const ImplicitFunction& b, const ContourSet& contours, const Work& work) {
    std::size_t next = 0;
    const std::size_t step = std::max<std::size_t>(1, point_count(contours) / kCompared);
    std::vector<Vec3> points;
    for (const Contour& contour : contours.contours)
        for (const Vec3& p : contour.points)
            if (next++ % step == 0) points.push_back(p);
    std::vector<double> before(points.size()), after(points.size());
    a.values(points, before, work);
    b.values(points, after, work);
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) largest = std::max(largest, std::abs(after[i] - before[i]));
    return largest;
}

}  // namespace kontur
