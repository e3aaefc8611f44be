// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/refit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "kontur/fit/constraints.h"
#include "kontur/fit/thin.h"

namespace kontur {
namespace {

constexpr std::size_t kCompared = 500;  // drawn points at which functions are
// From one point of the contours to the next, of the spacing and of the drawing's diameter, whichever is less: what is
// fitted is a change as smooth as the moves. Half as far costs a tenth of everything; half as far again lets contours go by
// 0.04 mm instead of 0.01.
constexpr double kBetween = 4, kBetweenOfDiameter = 0.015;
constexpr double kTolerance = 5e-4;  // of the spacing
constexpr double kNone = std::numeric_limits<double>::infinity();

double length_mm(const std::vector<BoundaryPoint>& points) {
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
        if (points[i].contour == points[i - 1].contour) length += distance(points[i].position, points[i - 1].position);
    return length;
}

struct Term {
    const ImplicitFunction& function;
    double factor;
};

/// Both have the same kernel and frame; a centre that both have is one.
ImplicitFunction sum(const Term& first, const Term& second) {
    std::vector<Vec3> centers;
    std::vector<double> weights;
    std::array<double, 4> polynomial{};
    std::map<std::array<double, 3>, std::size_t> number;
    for (const Term& term : {first, second}) {
        const ImplicitFunction& f = term.function;
        for (std::size_t i = 0; i < f.weights().size(); ++i) {
            const Vec3 c = f.centers()[i];
            const auto [at, is_new] = number.emplace(std::array{c.x, c.y, c.z}, centers.size());
            if (is_new) {
                centers.push_back(c);
                weights.push_back(0);
            }
            weights[at->second] += term.factor * f.weights()[i];
        }
        for (std::size_t i = 0; i < polynomial.size(); ++i) polynomial[i] += term.factor * f.polynomial()[i];
    }
    return {first.function.kernel(), first.function.frame(), PointArrays(centers), std::move(weights), polynomial};
}

/// How far f changes at a bound that it is held at: never to its other side.
double change_at(const Bound& bound, double change_mm) {
    const double least = bound.least_mm > -kNone ? 0 : -kNone, most = bound.most_mm < kNone ? 0 : kNone;
    return std::clamp(change_mm, least, most);
}

FittedFunction with_function(FittedFunction fitted, ImplicitFunction function) {
    fitted.function = std::move(function);
    fitted.report.centres = fitted.constraints = fitted.function.weights().size();
    return fitted;
}

}  // namespace

Refit::Refit(const PreparedContours& prepared, const FittedFunction& fitted, const FitOptions& options, double spacing_mm)
    : prepared_(prepared), fitted_(fitted), options_(resolved(options, prepared.ball.diameter())) {
    const double between_mm = std::min(kBetween * spacing_mm, kBetweenOfDiameter * prepared.ball.diameter());
    const auto most = static_cast<std::size_t>(std::ceil(length_mm(prepared.points) / between_mm));
    for (const std::size_t i : thin(prepared.points, std::max<std::size_t>(most, 1))) {
        points_.push_back(prepared.points[i]);
        points_.back().trust = 1;  // where contours contradict each other they yield to each other, and not to the image
        slopes_.push_back(fitted.slopes[i]);
    }
    // Fewer points weigh as much against smoothness as all would.
    const double share = static_cast<double>(points_.size()) / static_cast<double>(prepared.points.size());
    *options_.solve.smoothing *= share;
    *options_.slope_noise *= std::sqrt(share);
    options_.solve.tolerance_mm = std::max(*options_.solve.tolerance_mm, kTolerance * spacing_mm);
    options_.solve.ball = Ball3{fitted.function.frame().center, fitted.function.frame().scale};
    options_.solve.mean_radii = 0;
    contour_constraints_ = place_constraints(points_, slopes_, {}, place_options(options_)).constraints.size();
}

FittedFunction Refit::with(const ImageData& data, const Work& work) const {
    PlacedConstraints placement = place_constraints(points_, slopes_, changes(data, work), place_options(options_));
    std::fill_n(placement.constraints.values.begin(), contour_constraints_, 0.0);
    const Solution change = solve(placement.constraints, options_.solve, work);
    FittedFunction result = fitted_;
    result.report = change.report;
    result = with_function(std::move(result), sum({fitted_.function, 1}, {change.function, 1}));
    result.iterations += change.report.iterations;
    ++result.solves;
    return result;
}

/// What is known of g besides the contours.
std::vector<PointConstraint> Refit::changes(const ImageData& data, const Work& work) const {
    std::vector<PointConstraint> changes = fitted_.active_bounds;
    for (PointConstraint& bound : changes) bound.value = change_at(bound_at(bound.position), data.change_mm(bound.position));
    std::vector<Vec3> places;
    for (const PointConstraint& one : data.values) places.push_back(one.position);
    std::vector<double> before(places.size());
    // Without f's fall: that of the sum begins beyond these places, which are centres of it.
    fitted_.function.sums_at(PointArrays(fitted_.function.frame().to_unit(places)), before, work);
    for (std::size_t i = 0; i < before.size(); ++i) {
        changes.push_back(data.values[i]);
        changes.back().value -= before[i];
    }
    changes.insert(changes.end(), data.changes.begin(), data.changes.end());
    return changes;
}

const Bound& Refit::bound_at(const Vec3& place) const {
    return *std::ranges::find(prepared_.bounds, place, &Bound::position);
}

FittedFunction between(const FittedFunction& first, const FittedFunction& second, double share) {
    return with_function(second, sum({first.function, 1 - share}, {second.function, share}));
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
