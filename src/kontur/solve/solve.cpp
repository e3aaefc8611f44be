// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/pick.h"
#include "kontur/function/smoothing_of_noise.h"
#include "kontur/solve/linear_system.h"
#include "kontur/solve/solver_setup.h"

namespace kontur {
namespace {

/// The factorisations do not notice repeated rows reliably: rounding makes them garbage instead of zero pivots.
void check_distinct(const std::vector<Vec3>& centers) {
    std::vector<std::size_t> order(centers.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t i) { return std::array{centers[i].x, centers[i].y, centers[i].z}; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < order.size(); ++i)
        if (centers[order[i]] == centers[order[i - 1]]) {
            const auto [first, second] = std::minmax(order[i], order[i - 1]);
            throw Error(ErrorKind::singular_system, "constraints " + std::to_string(first + 1) + " and " +
                                                        std::to_string(second + 1) + " are at the same point");
        }
}

void check(const ConstraintSet& constraints, const SolveOptions& options) {
    const std::size_t least = options.kernel == Kernel::screened ? 1 : 4;
    if (constraints.size() < least)
        throw Error(ErrorKind::invalid_input,
                    "there are " + std::to_string(constraints.size()) + " constraints; at least " + std::to_string(least) +
                        (least == 4 ? " are needed, for a linear polynomial in space" : " is needed"));
    check_same_count("values", constraints.values.size(), "constraints", constraints.size());
    if (!constraints.trust.empty())
        check_same_count("degrees of trust", constraints.trust.size(), "constraints", constraints.size());
    if (!constraints.noise_mm.empty())
        check_same_count("noises", constraints.noise_mm.size(), "constraints", constraints.size());
    if (!constraints.extents.empty())
        check_same_count("extents", constraints.extents.size(), "constraints", constraints.size());
    for (std::size_t i = 0; i < constraints.extents.size(); ++i)
        if (!(constraints.extents[i] > 0 && constraints.extents[i] <= 1))
            throw Error(ErrorKind::invalid_input, fmt::format("the extent of constraint {} is {:g}; it must be in (0, 1]",
                                                              i + 1, constraints.extents[i]));
    for (std::size_t i = 0; i < constraints.noise_mm.size(); ++i)
        if (!(constraints.noise_mm[i] >= 0 && std::isfinite(constraints.noise_mm[i])))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the noise of constraint {} is {:g} mm; it must be finite and at "
                                    "least 0",
                                    i + 1, constraints.noise_mm[i]));
    for (std::size_t i = 0; i < constraints.size(); ++i)
        if (!is_finite(constraints.centers[i]) || !std::isfinite(constraints.values[i]))
            throw Error(ErrorKind::invalid_input, "constraint " + std::to_string(i + 1) + " is not finite");
    for (std::size_t i = 0; i < constraints.trust.size(); ++i)
        if (!(constraints.trust[i] > 0 && std::isfinite(constraints.trust[i])))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the trust in constraint {} is {:g}; it must be finite and above 0", i + 1,
                                    constraints.trust[i]));
    check_distinct(constraints.centers);
    check_solve_options(options);
}

void check_memory(std::size_t centers, double bytes_per_entry, const SolveOptions& options) {
    const double n = static_cast<double>(centers);
    const double mb = n * n * bytes_per_entry / (1 << 20);
    if (mb > options.max_memory_mb)
        throw Error(ErrorKind::too_large, "the " + std::string(name(options.solver)) + " solver needs " +
                                              std::to_string(static_cast<long long>(mb)) + " MB for " +
                                              std::to_string(centers) + " centres; the limit is " +
                                              std::to_string(static_cast<long long>(options.max_memory_mb)) + " MB");
}

Coefficients run(const LinearSystem& system, const SolveOptions& options, const Work& work) {
    if (options.solver == Solver::iterative) return solve_iterative(system, options, work);
    check_memory(system.size(), options.solver == Solver::dense ? 8 : 4, options);
    Coefficients c = options.solver == Solver::dense ? solve_dense(system) : solve_cholesky(system, work);
    c.residual = largest_residual(system, c, work);
    c.residual_points = system.size();
    return c;
}

/// Of the ball, or of all constraints.
double drawn_radius_mm(const SolveOptions& options, double unit_mm) {
    return options.ball && options.ball->radius > 0 ? options.ball->radius : unit_mm;
}

std::vector<double> smoothing_of(const ConstraintSet& constraints, const SolveOptions& options, double unit_mm) {
    // On the unit coordinates of a part of the extent e, the kernel is 1 / e^3 times as large, and noise / e as large.
    std::vector<double> extents = constraints.extents;
    extents.resize(constraints.size(), 1.0);
    for (double& extent : extents) extent *= drawn_radius_mm(options, unit_mm) / unit_mm;
    std::vector<double> smoothing;
    for (const double extent : extents) smoothing.push_back(*options.smoothing * std::pow(extent, 3));
    for (std::size_t i = 0; i < constraints.noise_mm.size(); ++i)
        smoothing[i] += smoothing_of_noise(constraints.noise_mm[i] / unit_mm) * extents[i];
    for (std::size_t i = 0; i < constraints.trust.size(); ++i) {
        smoothing[i] /= constraints.trust[i];
        if (!std::isfinite(smoothing[i]))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the smoothing is {:g}; divided by {:g}, the trust in constraint {}, it is not finite",
                                    *options.smoothing, constraints.trust[i], i + 1));
    }
    return smoothing;
}

/// phi of distances in mm is this much times phi of distances in the frame.
double kernel_scale(Kernel kernel, const UnitFrame& frame) {
    return kernel == Kernel::biharmonic ? frame.scale : frame.scale * frame.scale * frame.scale;
}

/// The ball's; with the screened kernel so wide that all centres are within reach of each other, clicks far from what was
/// drawn among them; but what has no mean is a change of another function, and keeps that one's frame.
UnitFrame frame_of(const ConstraintSet& constraints, const SolveOptions& options) {
    if (!options.ball) return unit_frame(constraints.centers);
    UnitFrame frame{options.ball->center, options.ball->radius > 0 ? options.ball->radius : 1.0};
    if (options.kernel == Kernel::screened && options.mean_radii != 0)
        for (const Vec3& p : constraints.centers)
            frame.scale = std::max(frame.scale, distance(p, frame.center) / (kScreenedReach / 2));
    return frame;
}

/// The weights of those centres that the previous solve had too; the others' are 0.
std::vector<double> start_weights(const std::vector<Vec3>& centers, const PreviousSolve& previous, double scale) {
    const auto key = [](const Vec3& p) { return std::array{p.x, p.y, p.z}; };
    std::map<std::array<double, 3>, double> values;
    for (std::size_t i = 0; i < previous.centers.size(); ++i) values[key(previous.centers[i])] = previous.weights[i];
    std::vector<double> start(centers.size(), 0.0);
    for (std::size_t i = 0; i < centers.size(); ++i)
        if (const auto entry = values.find(key(centers[i])); entry != values.end()) start[i] = scale * entry->second;
    return start;
}

/// A system's centres in mm, and by how much its weights are larger than those of phi of distances in mm.
struct InMillimetres {
    const std::vector<Vec3>& centers;
    double scale;
};

/// From where the previous solve ended: with its setup if that fits, or else with its weights.
Coefficients run_after(PreviousSolve& previous, LinearSystem& system, const InMillimetres& in_mm,
                       const SolveOptions& options, const Work& work) {
    if (previous.setup)
        if (std::optional<SharedSystem> shared = share(system, std::exchange(previous.setup, nullptr))) {
            Coefficients c = run(shared->system, options, work);
            c.weights = pick(c.weights, shared->places);
            c.pattern = nullptr;  // of other centres
            return c;
        }
    if (!previous.centers.empty()) system.start = start_weights(in_mm.centers, previous, in_mm.scale);
    if (previous.centers == in_mm.centers) system.pattern = previous.pattern;
    return run(system, options, work);
}

PreviousSolve remember(const ConstraintSet& constraints, const Coefficients& c, double scale) {
    PreviousSolve solve{constraints.centers, c.weights, c.pattern, c.setup};
    for (double& w : solve.weights) w /= scale;
    return solve;
}

}  // namespace

std::string_view name(Solver solver) noexcept {
    switch (solver) {
        case Solver::automatic:
            return "automatic";
        case Solver::iterative:
            return "iterative";
        case Solver::cholesky:
            return "cholesky";
        case Solver::dense:
            return "dense";
    }
    return "?";
}

SolveOptions resolved(SolveOptions options, double diameter_mm) {
    options.smoothing = options.smoothing.value_or(kSmoothing);
    options.tolerance_mm = options.tolerance_mm.value_or(kToleranceFraction * diameter_mm);
    return options;
}

void check_solve_options(const SolveOptions& options) {
    if (options.ball &&
        !(is_finite(options.ball->center) && options.ball->radius >= 0 && std::isfinite(options.ball->radius)))
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("the ball that sets the unit has a radius of {:g} mm; it and the centre must be finite and the "
                        "radius at least 0",
                        options.ball->radius));
    if (options.tolerance_mm) check_above_0("the solver's tolerance", *options.tolerance_mm, " mm");
    if (options.smoothing) check_not_below_0("the smoothing", *options.smoothing);
    if (!std::isfinite(options.mean_radii))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the function's mean is {:g} radii; it must be finite", options.mean_radii));
    check_at_least("the most iterations of the solver", options.max_iterations, 1);
    if (!(options.max_memory_mb > 0))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the solver's memory limit is {:g} MB; it must be above 0", options.max_memory_mb));
}

Solution solve(const ConstraintSet& constraints, const SolveOptions& requested, const Work& work, PreviousSolve* previous) {
    SolveOptions options = requested;
    if (options.solver == Solver::automatic) options.solver = Solver::iterative;
    check(constraints, options);
    check_threads(work.threads);
    if (previous)
        check_same_count("weights of the previous solve", previous->weights.size(), "centres", previous->centers.size());
    work.check();

    const bool screened = options.kernel == Kernel::screened;
    const UnitFrame frame = frame_of(constraints, options);
    const double radius_mm = drawn_radius_mm(options, frame.scale);
    options = resolved(options, 2 * radius_mm);
    const double mean = screened ? options.mean_radii * radius_mm : 0;
    LinearSystem system{options.kernel, smoothing_of(constraints, options, frame.scale),
                        PointArrays(frame.to_unit(constraints.centers)), constraints.values};
    for (double& value : system.values) value -= mean;
    if (!screened) static_cast<void>(spread_centers(system.centers));  // refuses centres in one plane: dsysv may not notice
    const double scale = kernel_scale(options.kernel, frame);
    Coefficients c =
        previous ? run_after(*previous, system, {constraints.centers, scale}, options, work) : run(system, options, work);
    const auto finite = [](double w) { return std::isfinite(w); };
    if (!finite(c.residual) || !std::ranges::all_of(c.weights, finite))
        throw Error(ErrorKind::singular_system, "the linear system has no finite solution");

    if (previous) *previous = remember(constraints, c, scale);
    Solution solution;
    solution.report = {options.solver,    system.size(), c.iterations,  c.residual,
                       c.residual_points, c.matrix_mb,   c.evaluations, c.seconds};
    if (screened) c.polynomial = {mean, 0, 0, 0};
    solution.function = ImplicitFunction(options.kernel, frame, system.centers, std::move(c.weights), c.polynomial);
    return solution;
}

}  // namespace kontur
