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

/// Every few of the points, evenly along the contours, about `most` > 0 in all; short contours keep more of theirs.
Indices thin(const std::vector<BoundaryPoint>& points, std::size_t most) {
    constexpr double kLeastPerStretch = 24;
    Indices kept;
    if (points.size() <= most) {
        kept.resize(points.size());
        std::iota(kept.begin(), kept.end(), std::size_t{0});
        return kept;
    }
    const std::vector<double> lengths = stretch_lengths(points);
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) total += follows(points, i) ? 0 : lengths[i];
    const double step = total / static_cast<double>(most);
    const std::size_t every = single_point_step(points, most);

    double since = 0;
    for (std::size_t i = 0, single = 0; i < points.size(); ++i) {
        if (points[i].contour == kNoContour && single++ % every != 0) continue;
        if (follows(points, i)) since += distance(points[i].position, points[i - 1].position);
        if (follows(points, i) && since < std::min(step, lengths[i] / kLeastPerStretch)) continue;
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

/// The caps and leak probes, and which of them have become constraints.
class ActiveCaps {
public:
    explicit ActiveCaps(const PreparedContours& contours) : first_probe_(contours.caps.size()) {
        for (const Cap& cap : contours.caps)
            caps_.push_back({cap, cap.from_start || (contours.coplanar && cap.kind == ConstraintKind::cap)});
        for (const Cap& probe : contours.leak_probes) caps_.push_back({probe});
    }

    /// Activates the caps that the function violates; true if there are new ones. Leak probes are looked at only when there
    /// are none: without its caps the object runs on, and what it meets there is no leak. Of the probes that the last
    /// function kept well, one of a few is looked at: a leak is larger than their distance. If it shows a leak, all are.
    /// A leak far beyond the ends does not bring back those that were forgotten near the object.
    bool update(const ImplicitFunction& function, int threads) {
        Indices caps(first_probe_), doubtful, others;
        std::iota(caps.begin(), caps.end(), std::size_t{0});
        const std::size_t before = count();
        evaluate(function, caps, threads);
        if (count() > before) return true;
        for (std::size_t i = first_probe_; i < caps_.size(); ++i) (is_doubtful(i) ? doubtful : others).push_back(i);
        evaluate(function, doubtful, threads);
        if (count() == before) return false;
        evaluate(function, others, threads);
        const bool leaks_near = std::any_of(caps_.cbegin() + static_cast<std::ptrdiff_t>(first_probe_), caps_.cend(),
                                            [](const Watched& probe) { return probe.active && !probe.cap.far; });
        for (Watched& watched : caps_)
            watched.active = watched.active || (watched.forgotten && (leaks_near || watched.cap.far));
        return true;
    }

    void append_to(std::vector<PointConstraint>& points) const {
        for (const Watched& watched : caps_)
            if (const Cap& cap = watched.cap; watched.active)
                points.push_back({cap.position, cap.value_mm, cap.kind, cap.trust});
    }

    /// Far probes that are constraints widen the unit ball in which smoothing is measured. By what it is to be multiplied so
    /// that they change nothing near the object.
    double smoothing_share(const std::vector<Vec3>& centers, Kernel kernel) const {
        const auto before = [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
        std::vector<Vec3> far, near;
        for (const Watched& watched : caps_)
            if (watched.active && watched.cap.far) far.push_back(watched.cap.position);
        if (far.empty() || kernel == Kernel::screened) return 1;
        std::sort(far.begin(), far.end(), before);
        std::copy_if(centers.begin(), centers.end(), std::back_inserter(near),
                     [&](const Vec3& p) { return !std::binary_search(far.begin(), far.end(), p, before); });
        return kernel_value(kernel, smallest_ball(near).radius / smallest_ball(centers).radius);
    }

    /// Leaks so far may come from the smoothing of early fits: they count again only if a fit from now on leaks, too.
    void forget_leaks() {
        for (std::size_t i = first_probe_; i < caps_.size(); ++i) caps_[i].forgotten = std::exchange(caps_[i].active, false);
    }

    std::size_t count() const {
        return static_cast<std::size_t>(
            std::count_if(caps_.begin(), caps_.end(), [](const Watched& w) { return w.active; }));
    }

private:
    struct Watched {
        Cap cap;
        bool active = false;
        bool forgotten = false;                                      ///< a leak of an early fit
        double value_mm = std::numeric_limits<double>::quiet_NaN();  ///< of the last function for which it was computed
    };

    bool is_doubtful(std::size_t i) const {
        constexpr std::size_t kSampleEvery = 4;
        return i % kSampleEvery == 0 || !(caps_[i].value_mm < caps_[i].cap.value_mm / 2);
    }

    void evaluate(const ImplicitFunction& function, const Indices& indices, int threads) {
        std::vector<Vec3> positions;
        for (const std::size_t i : indices) positions.push_back(caps_[i].cap.position);
        std::vector<double> values(indices.size());
        function.values(positions, values, threads);
        for (std::size_t n = 0; n < indices.size(); ++n) {
            Watched& watched = caps_[indices[n]];
            watched.value_mm = values[n];
            watched.active = watched.active || !watched.cap.allows(values[n]);
        }
    }

    std::vector<Watched> caps_;
    std::size_t first_probe_;  ///< of the leaks; behind all others
};

/// The solves of one fit, with what they share and what they leave behind.
class Fitter {
public:
    Fitter(const PreparedContours& contours, const FitOptions& options, const Progress& progress)
        : all_(contours.points), options_(options), progress_(progress), caps_(contours) {}

    /// Solves for points with these slopes; true if the function exceeds caps that it did not exceed before.
    bool solve_for(const std::vector<BoundaryPoint>& points, const std::vector<double>& slopes,
                   const SolveOptions& solving) {
        std::vector<PointConstraint> single_points;
        caps_.append_to(single_points);
        const PlacedConstraints placed = place_constraints(points, slopes, single_points, options_.place);
        SolveOptions near_object = solving;
        near_object.smoothing *= caps_.smoothing_share(placed.constraints.centers, solving.kernel);
        const Solution solution = solve(placed.constraints, near_object, progress_of_next_solve(), &previous_);
        result_.function = solution.function;
        result_.report = solution.report;
        result_.iterations += solution.report.iterations;
        result_.merged = placed.merged;
        result_.constraints = placed.constraints.size();
        ++result_.solves;
        return caps_.update(result_.function, options_.solve.threads);
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
        caps_.forget_leaks();
        const Indices kept = thin(all_, options_.most_points > 0 ? options_.most_points : all_.size());
        const std::vector<BoundaryPoint> points = pick(all_, kept);
        const std::vector<double> slopes = pick(result_.slopes, kept);
        SolveOptions solving = options_.solve;
        solving.smoothing *= share(points);
        for (int more = 0; solve_for(points, slopes, solving) && more < options_.cap_rounds;) ++more;
        result_.capped = caps_.count();
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
    const FitOptions& options_;
    const Progress& progress_;
    ActiveCaps caps_;
    PreviousSolve previous_;
    Fit result_;
};

}  // namespace

std::string_view name(Normals normals) noexcept { return normals == Normals::surface ? "surface" : "in-plane"; }

void check_fit_options(const FitOptions& options, std::size_t points) {
    check_at_least("the number of rounds", options.rounds, 0);
    check_at_least("the number of rounds for caps", options.cap_rounds, 0);
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
