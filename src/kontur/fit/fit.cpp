// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/pick.h"
#include "kontur/bounds/clicks.h"
#include "kontur/fit/active_bounds.h"
#include "kontur/fit/click_guards.h"
#include "kontur/fit/telling_points.h"
#include "kontur/fit/thin.h"
#include "kontur/fit/tilt_trust.h"

namespace kontur {
namespace {

// Where they are not given; docs/decisions/0001-surface-normals.md has the measurements.
constexpr double kOffsetFraction = 1.35e-2;  // of the drawing's diameter: normal constraints on both sides, soft
constexpr double kSpacingOfOffset = 0.75;    // from one to the next along a line at least; a third more on average
// Of the drawing's diameter. Half of it keeps a tenth more points, three times as much changes a mask by .0002.
constexpr double kLineTolerance = 1e-4;
constexpr double kSlopeNoise = 0.21;  // what the tilt of an organ's surface is known to

/// Cosine of the angle between the surface's normal and the contour's plane.
double slope(const BoundaryPoint& point, const Vec3& gradient, double least_slope) {
    const Vec3 outward = -gradient;
    const double inplane = std::max(dot(outward, point.inplane_normal), least_slope * norm(outward));
    const double tilt = dot(outward, point.plane_normal);
    return inplane > 0 ? inplane / std::hypot(inplane, tilt) : 1.0;
}

/// The slopes that the function's gradient shows at the points.
std::vector<double> read_slopes(const ImplicitFunction& function, const std::vector<BoundaryPoint>& points,
                                const FitOptions& options, const Work& work) {
    std::vector<Vec3> positions(points.size()), gradients(points.size());
    std::transform(points.begin(), points.end(), positions.begin(), [](const BoundaryPoint& p) { return p.position; });
    function.gradients(positions, gradients, work);
    std::vector<double> slopes(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) slopes[i] = slope(points[i], gradients[i], options.least_slope);
    return slopes;
}

/// Whatever order they were drawn in, so that sums and choices among neighbours that are equally near are the same.
PlacedConstraints in_order_of_place(PlacedConstraints placement) {
    ConstraintSet& set = placement.constraints;
    std::vector<std::size_t> order(set.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t i) { return std::tuple(set.centers[i].x, set.centers[i].y, set.centers[i].z); };
    std::ranges::sort(order, {}, key);
    set = {pick(set.centers, order), pick(set.values, order), pick(set.trust, order), pick(set.noise_mm, order),
           pick(set.extents, order)};
    return placement;
}

/// Points of which none stands for more of its line than another.
TellingPoints equally(std::vector<std::size_t> numbers) {
    std::vector<double> weights(numbers.size(), 1.0);
    return {std::move(numbers), std::move(weights)};
}

double mean_change_degrees(const std::vector<double>& before, const std::vector<double>& after) {
    double change = 0;
    for (std::size_t i = 0; i < after.size(); ++i)
        change += std::abs(std::acos(std::min(after[i], 1.0)) - std::acos(std::min(before[i], 1.0)));
    return change / static_cast<double>(after.size()) * 180 / M_PI;
}

// Solves of a part of the points that settle which bounds are held. Each lets go of a share of those that are held in vain,
// and the hundreds of bounds of a vertebra take six.
constexpr int kMostSettling = 10;
// They need not be as exact as the last one, which shows whether they were right.
constexpr double kSettlingTolerance = 3;
// Of the noise of a bound that is held though f would keep it, and pulls it the wrong way. While bounds are settled it is
// let go of: which ones are held else depends on the way there, and the volume jumps where that is another. All points are
// not worth another solve for it: what is left lies far from the surface, which moves by a hundredth of a millimetre.
constexpr double kCountsHeld = 0.5;

// Of the points, how many may tell the lines for a fit by them to be tried. An unsteady hand's are nine tenths, those of
// smooth lines a third at most.
constexpr double kWorthTrying = 0.5;
// Of the tolerance, by how much f may miss a point that took no part: it misses one in a thousand by as much.
constexpr double kMostMissed = 2;

/// The solves of one fit, with what they share and what they leave behind.
class Solves {
public:
    Solves(const PreparedContours& contours, const FitOptions& options, const Work& work)
        : all_(contours.points),
          ball_(contours.ball),
          options_(options),
          place_(place_options(options)),
          work_(work),
          bounds_(contours.bounds, contours.points) {}

    FittedFunction run() {
        const std::vector<std::size_t> part = thin(all_, options_.most_points > 0 ? options_.most_points : all_.size());
        result_.slopes = options_.start_slopes;
        result_.slopes.resize(all_.size(), 1.0);
        if (options_.normals == Normals::surface && options_.rounds > 0) {
            find_slopes();
            settle_bounds(part.size());
        } else {
            bounds_.hold(options_.start_bounds);
        }
        progress_ = {progress_.end, 1.0};
        if (!solve_few()) solve_until_settled(equally(part));
        return std::move(result_);
    }

private:
    /// A stretch of the whole progress.
    struct ProgressSpan {
        double begin = 0, end = 0;
    };

    /// Finds the tilts of the surface from a part of the points.
    void find_slopes() {
        const std::vector<std::size_t> part = thin(all_, options_.tilt_points);
        const std::vector<BoundaryPoint> points = pick(all_, part);
        std::vector<double> slopes = pick(result_.slopes, part);
        SolveOptions solving = options_.solve;
        *solving.tolerance_mm *= options_.early_tolerance_factor;
        double smoothing = options_.start_smoothing;
        for (int round = 0; round < options_.rounds; ++round, smoothing *= options_.smoothing_factor) {
            progress_ = {progress_.end, progress_.end + 0.5 / options_.rounds};
            solving.smoothing = share(points) * std::max(smoothing, *options_.solve.smoothing);
            solve_for(points, slopes, place_, solving);
            bounds_.update(result_.function, 2 * *solving.tolerance_mm, kCountsHeld, work_);
            std::vector<double> next = read_slopes(result_.function, points, options_, work_);
            result_.tilt_change_degrees = mean_change_degrees(slopes, next);
            slopes = std::move(next);
        }
        const std::vector<double> readings = read_slopes(result_.function, all_, options_, work_);
        result_.slopes = believed_slopes(all_, part, readings, place_.normal_offset_mm);
    }

    /// Finds which bounds a fit of so many points leans on, from half as many at most: that fit is repeated less often then.
    void settle_bounds(std::size_t part_size) {
        if (!bounds_.holds_any() || options_.most_solves == 1) return;
        const TellingPoints part = equally(thin(all_, std::clamp(part_size / 2, std::size_t{1}, options_.tilt_points)));
        // Each begins anew: what is left of an earlier start would decide which bounds are held.
        for (int solve = 0; solve < kMostSettling && solve_part(part, kSettlingTolerance, kCounts); ++solve)
            previous_.setup.reset();
    }

    /// The fit by the points that tell the lines; false where they are too many to be worth a try, or do not tell them.
    bool solve_few() {
        if (options_.most_points > 0 || *options_.line_tolerance_mm == 0) return false;
        const TellingPoints telling = telling_points(all_, *options_.line_tolerance_mm);
        if (static_cast<double>(telling.numbers.size()) > kWorthTrying * static_cast<double>(all_.size())) return false;
        solve_until_settled(telling);
        std::vector<Vec3> positions(all_.size());
        std::ranges::transform(all_, positions.begin(), &BoundaryPoint::position);
        std::vector<double> values(all_.size());
        result_.function.values(positions, values, work_);
        if (tell_the_rest(telling, all_, values, kMostMissed * *options_.line_tolerance_mm)) return true;
        result_.full_solves = 0;
        return false;
    }

    void solve_until_settled(const TellingPoints& telling) {
        for (bool other_bounds = true; other_bounds && result_.full_solves < options_.most_solves;)
            other_bounds = solve_part(telling, 1, kCountsHeld, ++result_.full_solves == options_.most_solves);
    }

    /// The fit with the slopes that were found, from a part of the points; true if other bounds should have been held, which
    /// is not asked of the last one: bounds are many.
    bool solve_part(const TellingPoints& part, double tolerance_factor, double held_counts, bool is_last = false) {
        std::vector<BoundaryPoint> points = pick(all_, part.numbers);
        for (std::size_t i = 0; i < points.size(); ++i) points[i].trust *= part.weights[i];
        SolveOptions solving = options_.solve;
        *solving.smoothing *= share(points);
        *solving.tolerance_mm *= tolerance_factor;
        PlaceOptions placing = place_;
        placing.slope_noise *= std::sqrt(share(points));
        solve_for(points, pick(result_.slopes, part.numbers), placing, solving);
        const double counts_mm = tolerance_factor * options_.bounds_tolerance_mm.value_or(2 * *options_.solve.tolerance_mm);
        return !is_last && bounds_.update(result_.function, counts_mm, held_counts, work_);
    }

    /// Solves for points with these slopes, with the bounds that are held.
    void solve_for(const std::vector<BoundaryPoint>& points, const std::vector<double>& slopes, const PlaceOptions& placing,
                   const SolveOptions& solving) {
        std::vector<PointConstraint> single_points;
        bounds_.append_to(single_points);
        result_.bounded = single_points.size();
        result_.active_bounds = single_points;
        PlacedConstraints placement = place_constraints(points, slopes, single_points, placing);
        solve_placed(placing.both_sides ? in_order_of_place(std::move(placement)) : placement, solving);
    }

    /// With the screened kernel in the ball of what was drawn unless the options have one.
    void solve_placed(const PlacedConstraints& placement, SolveOptions solving) {
        if (solving.kernel == Kernel::screened && !solving.ball) solving.ball = ball_;
        Solution solution = solve(placement.constraints, solving, work_of_stretch(), &previous_);
        result_.function = std::move(solution.function);
        result_.report = std::move(solution.report);
        result_.iterations += result_.report.iterations;
        result_.merged = placement.merged;
        result_.constraints = placement.constraints.size();
        ++result_.solves;
    }

    /// By which smoothing is reduced so that fewer points weigh as much against smoothness as all would.
    double share(const std::vector<BoundaryPoint>& part) const {
        return static_cast<double>(part.size()) / static_cast<double>(all_.size());
    }

    Work work_of_stretch() const {
        if (!work_.callback) return work_;
        return {work_.threads,
                [this, stretch = progress_](std::string_view stage, double done) {
                    work_.callback(stage, stretch.begin + (stretch.end - stretch.begin) * done);
                },
                work_.stop};
    }

    const std::vector<BoundaryPoint>& all_;
    const Ball3& ball_;
    const FitOptions& options_;
    const PlaceOptions place_;
    const Work& work_;
    ActiveBounds bounds_;
    PreviousSolve previous_;
    ProgressSpan progress_;
    FittedFunction result_;
};

/// What clicks must not do besides, from a fit of as many points as show the tilts.
std::vector<Bound> guards_of(const PreparedContours& contours, const FitOptions& options, const Work& work) {
    if (options.normals != Normals::surface || std::ranges::none_of(contours.bounds, is_click)) return {};
    PreparedContours without = contours;
    std::erase_if(without.bounds, is_click);
    FitOptions coarse = options;
    coarse.most_points = options.tilt_points;
    coarse.most_solves = 1;
    coarse.start_bounds.clear();
    return click_guards(contours, Solves(without, coarse, work.untold()).run().function, work);
}

}  // namespace

std::string_view name(Normals normals) noexcept { return normals == Normals::surface ? "surface" : "in-plane"; }

void check_fit_options(const FitOptions& options, std::size_t points) {
    if (points == 0) throw Error(ErrorKind::invalid_input, "there are 0 points to fit a function to; at least 1 is needed");
    check_at_least("the number of rounds", options.rounds, 0);
    check_at_least("the number of solves with all points", options.most_solves, 1);
    check_not_below_0("the start's smoothing", options.start_smoothing);
    check_not_below_0("the smoothing's factor", options.smoothing_factor);
    if (!(options.least_slope > 0 && options.least_slope <= 1))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the least slope is {:g}; it must be in (0, 1]", options.least_slope));
    check_above_0("the early tolerance's factor", options.early_tolerance_factor);
    if (options.line_tolerance_mm) check_not_below_0("the lines' tolerance", *options.line_tolerance_mm, " mm");
    if (options.bounds_tolerance_mm) check_not_below_0("the bounds' tolerance", *options.bounds_tolerance_mm, " mm");
    if (options.tilt_points < 1)
        throw Error(ErrorKind::invalid_input, "the tilts are to be found from 0 points; at least 1 is needed");
    if (!options.start_slopes.empty()) check_slopes(options.start_slopes, points);
    check_solve_options(options.solve);  // before the early solves, which change them
}

FitOptions resolved(FitOptions options, double diameter_mm) {
    const bool is_surface = options.normals == Normals::surface;
    const double offset_mm =
        options.normal_offset_mm.value_or((is_surface ? kOffsetFraction : kMarginFraction) * diameter_mm);
    options.normal_offset_mm = offset_mm;
    options.both_sides = options.both_sides.value_or(is_surface);
    options.normal_spacing_mm = options.normal_spacing_mm.value_or(is_surface ? kSpacingOfOffset * offset_mm : 0);
    options.slope_noise = options.slope_noise.value_or(is_surface ? kSlopeNoise : 0);
    options.merge_distance_mm = options.merge_distance_mm.value_or(kMergeFraction * diameter_mm);
    if (!is_surface) options.solve.smoothing = options.solve.smoothing.value_or(0.0);
    options.solve = resolved(options.solve, diameter_mm);
    const bool may_leave_out = is_surface && *options.solve.smoothing > 0;
    options.line_tolerance_mm = options.line_tolerance_mm.value_or(may_leave_out ? kLineTolerance * diameter_mm : 0);
    check_place_options(place_options(options));
    return options;
}

PlaceOptions place_options(const FitOptions& options) {
    return {.normal_offset_mm = options.normal_offset_mm.value(),
            .both_sides = options.both_sides.value(),
            .normal_spacing_mm = options.normal_spacing_mm.value(),
            .slope_noise = options.slope_noise.value(),
            .merge_distance_mm = options.merge_distance_mm.value()};
}

FittedFunction fit(const PreparedContours& contours, const FitOptions& given_options, const Work& work) {
    check_fit_options(given_options, contours.points.size());
    const FitOptions options = resolved(given_options, contours.ball.diameter());
    const std::vector<Bound> guards = guards_of(contours, options, work);
    if (guards.empty()) return Solves(contours, options, work).run();
    PreparedContours with_guards = contours;
    with_guards.bounds.insert(with_guards.bounds.end(), guards.begin(), guards.end());
    return Solves(with_guards, options, work).run();
}

}  // namespace kontur
