// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/smallest_ball.h"

namespace kontur {
namespace {

/// Cosine of the angle between the surface's normal and the contour's plane.
double slope(const BoundaryPoint& point, const Vec3& gradient, double least_slope) {
    const Vec3 outward = -gradient;
    const double inplane = std::max(dot(outward, point.inplane_normal), least_slope * norm(outward));
    const double tilt = dot(outward, point.plane_normal);
    return inplane > 0 ? inplane / std::hypot(inplane, tilt) : 1.0;
}

using Indices = std::vector<std::size_t>;

template <class T>
std::vector<T> pick(const std::vector<T>& from, const Indices& indices) {
    std::vector<T> picked;
    picked.reserve(indices.size());
    for (const std::size_t i : indices) picked.push_back(from[i]);
    return picked;
}

/// Whether a point goes on from the one before it along the same line. The contours' numbers need not be in order, a contour
/// may have several stretches (its lid is one), and single points belong to none.
bool follows(const std::vector<BoundaryPoint>& points, std::size_t i) {
    return i > 0 && points[i].contour != kNoContour && points[i].contour == points[i - 1].contour;
}

/// For each point the length of its stretch: consecutive points of one contour; 0 for single points.
std::vector<double> stretch_lengths(const std::vector<BoundaryPoint>& points) {
    std::vector<double> lengths(points.size(), 0.0);
    for (std::size_t first = 0, next = 1; first < points.size(); first = next++) {
        double length = 0;
        for (; next < points.size() && follows(points, next); ++next)
            length += distance(points[next].position, points[next - 1].position);
        std::fill(lengths.begin() + static_cast<std::ptrdiff_t>(first), lengths.begin() + static_cast<std::ptrdiff_t>(next),
                  length);
    }
    return lengths;
}

/// Of how many single points one stays: all do unless they alone are more than `most`.
std::size_t single_point_step(const std::vector<BoundaryPoint>& points, std::size_t most) {
    const auto singles = static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [](const BoundaryPoint& p) { return p.contour == kNoContour; }));
    return (singles + most - 1) / most;
}

/// Every few of the points, evenly along the contours, about `most` > 0 in all; short contours keep more of theirs, unless
/// there are very many of them.
Indices thin(const std::vector<BoundaryPoint>& points, std::size_t most) {
    constexpr double kMostPerShort = 24, kLeastPerShort = 6;
    Indices kept;
    if (points.size() <= most) {
        kept.resize(points.size());
        std::iota(kept.begin(), kept.end(), std::size_t{0});
        return kept;
    }
    const std::vector<double> lengths = stretch_lengths(points);
    double total = 0, stretches = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!follows(points, i)) {
            total += lengths[i];
            ++stretches;
        }
    const double per_short =
        std::clamp(4 * static_cast<double>(most) / std::max(stretches, 1.0), kLeastPerShort, kMostPerShort);
    const double step = total / static_cast<double>(most);
    const std::size_t every = single_point_step(points, most);

    double since = 0;
    for (std::size_t i = 0, single = 0; i < points.size(); ++i) {
        if (points[i].contour == kNoContour && single++ % every != 0) continue;
        if (follows(points, i)) since += distance(points[i].position, points[i - 1].position);
        if (follows(points, i) && since < std::min(step, lengths[i] / per_short)) continue;
        kept.push_back(i);
        since = 0;
    }
    return kept;
}

/// The slopes that the function's gradient shows at the points.
std::vector<double> read_slopes(const ImplicitFunction& function, const std::vector<BoundaryPoint>& points,
                                const FitOptions& options) {
    std::vector<Vec3> positions(points.size()), gradients(points.size());
    std::transform(points.begin(), points.end(), positions.begin(), [](const BoundaryPoint& p) { return p.position; });
    function.gradients(positions, gradients, options.solve.threads);
    std::vector<double> slopes(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) slopes[i] = slope(points[i], gradients[i], options.least_slope);
    return slopes;
}

double mean_change_degrees(const std::vector<double>& before, const std::vector<double>& after) {
    double change = 0;
    for (std::size_t i = 0; i < after.size(); ++i)
        change += std::abs(std::acos(std::min(after[i], 1.0)) - std::acos(std::min(before[i], 1.0)));
    return change / static_cast<double>(after.size()) * 180 / M_PI;
}

/// The bounds, and at which limit of theirs f is held.
class ActiveBounds {
public:
    explicit ActiveBounds(const std::vector<Bound>& bounds) : bounds_(bounds), held_(bounds.size(), Held::no) {
        for (const Bound& bound : bounds) positions_.push_back(bound.position);
    }

    /// Holds f where it leaves its interval, and lets it go where it keeps it by itself; true if that changed anything.
    bool update(const ImplicitFunction& function, double tolerance_mm, int threads) {
        std::vector<double> values(bounds_.size());
        function.values(positions_, values, threads);
        bool changed = false;
        for (std::size_t i = 0; i < bounds_.size(); ++i) {
            const double slack = held_[i] == Held::no ? tolerance_mm : 0;
            const Held next = values[i] > bounds_[i].most_mm + slack    ? Held::at_most
                              : values[i] < bounds_[i].least_mm - slack ? Held::at_least
                                                                        : Held::no;
            changed = changed || next != held_[i];
            held_[i] = next;
        }
        return changed;
    }

    void append_to(std::vector<PointConstraint>& points) const {
        for (std::size_t i = 0; i < bounds_.size(); ++i) {
            const Bound& bound = bounds_[i];
            if (held_[i] == Held::no) continue;
            points.push_back({.position = bound.position,
                              .value = held_[i] == Held::at_most ? bound.most_mm : bound.least_mm,
                              .kind = bound.kind,
                              .noise_mm = bound.noise_mm});
        }
    }

private:
    enum class Held : std::uint8_t { no, at_least, at_most };

    const std::vector<Bound>& bounds_;
    std::vector<Vec3> positions_;
    std::vector<Held> held_;
};

/// The solves of one fit, with what they share and what they leave behind.
class Fitter {
public:
    Fitter(const PreparedContours& contours, const FitOptions& options, const Progress& progress)
        : all_(contours.points), ball_(contours.ball), options_(options), progress_(progress), bounds_(contours.bounds) {}

    /// Solves for points with these slopes; true if other bounds should have been held.
    bool solve_for(const std::vector<BoundaryPoint>& points, const std::vector<double>& slopes,
                   const SolveOptions& solving) {
        std::vector<PointConstraint> single_points;
        bounds_.append_to(single_points);
        result_.bounded = single_points.size();
        const PlacedConstraints placed = place_constraints(points, slopes, single_points, options_.place);
        SolveOptions in_ball = solving;
        if (solving.kernel == Kernel::screened && !solving.ball) in_ball.ball = ball_;
        const Solution solution = solve(placed.constraints, in_ball, progress_of_next_solve(), &previous_);
        result_.function = solution.function;
        result_.report = solution.report;
        result_.iterations += solution.report.iterations;
        result_.merged = placed.merged;
        result_.constraints = placed.constraints.size();
        ++result_.solves;
        return bounds_.update(result_.function, 2 * solving.tolerance_mm, options_.solve.threads);
    }

    /// Finds the tilts of the surface from a part of the points.
    void find_slopes() {
        const Indices part = thin(all_, options_.tilt_points);
        const std::vector<BoundaryPoint> points = pick(all_, part);
        std::vector<double> slopes = pick(result_.slopes, part);
        SolveOptions solving = options_.solve;
        solving.tolerance_mm *= options_.early_tolerance_factor;
        double smoothing = options_.start_smoothing;
        for (int round = 0; round < options_.rounds; ++round, smoothing *= options_.smoothing_factor) {
            solving.smoothing = share(points) * std::max(smoothing, options_.solve.smoothing);
            solve_for(points, slopes, solving);
            std::vector<double> next = read_slopes(result_.function, points, options_);
            result_.tilt_change_degrees = mean_change_degrees(slopes, next);
            slopes = std::move(next);
        }
        result_.slopes = read_slopes(result_.function, all_, options_);
    }

    Fit run() {
        result_.slopes = options_.start_slopes;
        result_.slopes.resize(all_.size(), 1.0);
        if (finds_slopes()) find_slopes();
        const Indices kept = thin(all_, options_.most_points > 0 ? options_.most_points : all_.size());
        const std::vector<BoundaryPoint> points = pick(all_, kept);
        const std::vector<double> slopes = pick(result_.slopes, kept);
        SolveOptions solving = options_.solve;
        solving.smoothing *= share(points);
        for (int more = 0; solve_for(points, slopes, solving) && more + 1 < options_.most_solves;) ++more;
        return std::move(result_);
    }

private:
    /// By which smoothing is reduced so that fewer points weigh as much against smoothness as all would.
    double share(const std::vector<BoundaryPoint>& part) const {
        return static_cast<double>(part.size()) / static_cast<double>(all_.size());
    }

    bool finds_slopes() const { return options_.normals == Normals::surface && options_.rounds > 0; }

    /// Of the whole progress, half belongs to the tilts: there are more solves, but smaller ones.
    Progress progress_of_next_solve() const {
        if (!progress_.callback) return progress_;
        const int early = finds_slopes() ? options_.rounds : 0;
        const bool is_early = result_.solves < early;
        const double share = is_early ? 0.5 / early : early > 0 ? 0.5 : 1.0;
        const double before = is_early ? share * result_.solves : 1.0 - share;
        return {
            [this, before, share](std::string_view stage, double done) { progress_.callback(stage, before + share * done); },
            progress_.stop};
    }

    const std::vector<BoundaryPoint>& all_;
    const std::optional<Ball3>& ball_;
    const FitOptions& options_;
    const Progress& progress_;
    ActiveBounds bounds_;
    PreviousSolve previous_;
    Fit result_;
};

}  // namespace

std::string_view name(Normals normals) noexcept { return normals == Normals::surface ? "surface" : "in-plane"; }

void check_fit_options(const FitOptions& options, std::size_t points) {
    check_at_least("the number of rounds", options.rounds, 0);
    check_at_least("the number of solves with all points", options.most_solves, 1);
    check_not_below_0("the start's smoothing", options.start_smoothing);
    check_not_below_0("the smoothing's factor", options.smoothing_factor);
    if (!(options.least_slope > 0 && options.least_slope <= 1))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the least slope is {:g}; it must be in (0, 1]", options.least_slope));
    check_above_0("the early tolerance's factor", options.early_tolerance_factor);
    if (options.tilt_points < 1)
        throw Error(ErrorKind::invalid_input, "the tilts are to be found from 0 points; at least 1 is needed");
    if (!options.start_slopes.empty()) check_slopes(options.start_slopes, points);
    check_place_options(options.place);
    check_solve_options(options.solve);  // before the early solves, which change them
}

Fit fit(const PreparedContours& contours, const FitOptions& options, const Progress& progress) {
    check_fit_options(options, contours.points.size());
    return Fitter(contours, options, progress).run();
}

}  // namespace kontur
