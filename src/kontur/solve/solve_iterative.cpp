// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/solve/preconditioner.h"
#include "kontur/solve/projected_operator.h"
#include "kontur/solve/solver_setup.h"

#include <fmt/format.h>

namespace kontur {
namespace {

// Tolerances of the H2 matrix: rounding hides what is finer, and coarser ones, hardly cheaper, could make it indefinite.
constexpr double kFinest = 1e-14, kCoarsest = 1e-9;
// The largest error of a product over the tolerance times the norm of the weights; measured: 1 to 11.
constexpr double kErrorFactor = 10;
// Of the limit, the largest error of the H2 matrix beside which the rest is left to the iteration.
constexpr double kMostDeviation = 0.7;
// While the matrix is as exact as the limit demands, the residual may grow for some iterations, but not for so many.
constexpr int kMostIdle = 40;
// Of the rounding of one product, how much less than the residual that is asked for it must be for none to be computed
// afresh.
constexpr double kDrift = 1e3;

/// A tolerance at which products with weights like these are wrong by half the limit at most.
double matrix_tolerance(const Vector& weights, double limit_mm) {
    const double norm = std::sqrt(inner(weights, weights));
    return std::clamp(0.5 * limit_mm / (kErrorFactor * norm), kFinest, kCoarsest);
}

/// The linear polynomial that fits `values` at the centres; they are one up to the residual.
std::array<double, 4> fit_linear(const LinearSystem& system, const Vector& values) {
    const std::size_t n = values.size();
    Vec3 mean;
    double mean_value = 0;
    for (std::size_t i = 0; i < n; ++i) {
        mean += system.centers[i];
        mean_value += values[i];
    }
    mean *= 1.0 / static_cast<double>(n);
    mean_value /= static_cast<double>(n);
    Affine3 normal_matrix;
    normal_matrix.linear = {};
    Vec3 right;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 d = system.centers[i] - mean;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) normal_matrix.linear[r][c] += d[r] * d[c];
        right += (values[i] - mean_value) * d;
    }
    const Vec3 gradient = normal_matrix.inverse().apply_linear(right);
    return {mean_value - dot(gradient, mean), gradient.x, gradient.y, gradient.z};
}

/// Wall time by stage, in the order in which stages first ran.
class StageTimes {
public:
    /// The work's result; its time is added to the stage's.
    template <class Task>
    auto operator()(const char* stage, const Task& task) {
        using Clock = std::chrono::steady_clock;
        struct Timer {
            double& sum;
            Clock::time_point start = Clock::now();
            ~Timer() { sum += std::chrono::duration<double>(Clock::now() - start).count(); }
        } timer{of(stage)};
        return task();
    }
    const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

private:
    double& of(const char* stage) {
        for (auto& [name, sum] : seconds_)
            if (name == stage) return sum;
        return seconds_.emplace_back(stage, 0.0).second;
    }
    std::vector<std::pair<std::string, double>> seconds_;
};

std::shared_ptr<const PreconditionerPattern> pattern_of(const LinearSystem& system, const Work& work) {
    if (system.pattern) return system.pattern;
    if (system.setup)
        return std::make_shared<const PreconditionerPattern>(*system.setup->preconditioner->pattern(), system.centers);
    return std::make_shared<const PreconditionerPattern>(system.centers, PreconditionerOptions{}, work);
}

std::shared_ptr<const Preconditioner> preconditioner_of(const LinearSystem& system,
                                                        std::shared_ptr<const PreconditionerPattern> pattern,
                                                        const Work& work) {
    if (system.setup)
        return std::make_shared<const Preconditioner>(*system.setup->preconditioner, system.kernel, std::move(pattern),
                                                      Diagonals{system.setup->smoothing, system.smoothing}, work);
    return std::make_shared<const Preconditioner>(system.kernel, std::move(pattern), system.smoothing, work);
}

/// Solves by conjugate gradients and checks what they have reached.
class IterativeSolver {
public:
    IterativeSolver(const LinearSystem& system, const SolveOptions& options, const Work& work)
        : system_(system),
          options_(options),
          work_(work),
          limit_(*options.tolerance_mm),
          goal_(0.5 * limit_),
          conditions_(system),
          pattern_(times_("neighbours", [&] { return pattern_of(system, work); })),
          preconditioner_(times_("factors", [&] { return preconditioner_of(system, pattern_, work); })),
          weights_(system.start.empty() ? Vector(system.size(), 0.0) : system.start),
          target_(system.values),
          image_{.values = Vector(system.size()), .checked = system.size()} {
        for (double& v : target_) v *= kernel_sign(system.kernel);
        conditions_.project(target_);
        start_ = std::max(largest(target_), limit_);
        // The preconditioner's first guess at the weights tells how large they are.
        const double tolerance = matrix_tolerance(precondition(target_), limit_);
        times_("matrix", [&] { operator_.emplace(system, conditions_, tolerance, options, work); });
        conditions_.project(weights_);
        update_residual();
        if (!system.start.empty()) start_from_weights();
    }

    /// The recurrence's residual drifts from the true one, and H2 products are not exact: at the end the residual is
    /// computed afresh where that may matter, and the iteration restarted from there, with better products if they are to
    /// blame, as long as that helps.
    void run() {
        double last_residual = std::numeric_limits<double>::infinity(), last_deviation = last_residual;
        while (true) {
            const bool stuck = !descend();
            conditions_.project(weights_);
            check_image(stuck);
            if (residual_ <= limit_) return;
            const bool to_blame = stuck || image_.deviation > kMostDeviation * limit_;
            if (!operator_->matrix()->is_exact() && to_blame && operator_->tolerance() > kFinest &&
                (stuck || image_.deviation < 0.5 * last_deviation))
                tighten();
            else if (!(residual_ < 0.5 * last_residual)) return;
            last_residual = residual_;
            last_deviation = image_.deviation;
        }
    }

    Coefficients result() {
        Coefficients c;
        Vector residual = system_.values;
        add_scaled(residual, -kernel_sign(system_.kernel), image_.values);
        if (system_.kernel != Kernel::screened) c.polynomial = fit_linear(system_, residual);
        c.weights = std::move(weights_);
        c.iterations = iterations_;
        c.residual = residual_;
        c.residual_points = image_.checked;
        c.matrix_mb = preconditioner_->megabytes() + operator_->matrix()->megabytes();
        c.evaluations = operator_->matrix()->evaluations();
        c.seconds = times_.seconds();
        c.pattern = pattern_;
        c.setup = std::make_shared<const SolverSetup>(SolverSetup{
            system_.centers, system_.smoothing, c.weights, system_.setup ? system_.setup->first_centers : system_.size(),
            preconditioner_, operator_->matrix(), operator_->tolerance()});
        return c;
    }

private:
    /// Unless they are worse than none: weights that lost what balanced them leave residuals of kilometres.
    void start_from_weights() {
        const double without = residual_;
        image_.values = times_("products", [&] { return (*operator_)(weights_); });
        update_residual();
        if (residual_ < without) return;
        weights_.assign(weights_.size(), 0.0);
        image_.values.assign(weights_.size(), 0.0);
        update_residual();
    }

    Vector precondition(const Vector& r) {
        Vector z(r.size());
        times_("preconditioning", [&] { preconditioner_->apply(r, z); });
        conditions_.project(z);
        return z;
    }

    /// False if it ended early: rounding, or the matrix's error, has taken over.
    bool descend() {
        Vector z = precondition(r_), direction = z;
        double rz = inner(r_, z), least = largest(r_);
        for (int idle = 0; largest(r_) > goal_ && iterations_ < options_.max_iterations && rz > 0; ++iterations_) {
            const Vector step = times_("products", [&] { return (*operator_)(direction); });
            const double curvature = inner(direction, step);
            if (!(curvature > 0) || idle == kMostIdle) return false;
            add_scaled(weights_, rz / curvature, direction);
            add_scaled(r_, -rz / curvature, step);
            z = precondition(r_);
            const double next = inner(r_, z);
            for (std::size_t i = 0; i < z.size(); ++i) direction[i] = z[i] + next / rz * direction[i];
            rz = next;
            idle = largest(r_) < least ? 0 : idle + 1;
            least = std::min(least, largest(r_));
            const double progress = std::log(start_ / std::max(least, limit_)) / std::log(start_ / limit_ + 1e-9);
            work_.report("solve", std::clamp(progress, 0.0, 1.0));
        }
        return true;
    }

    void tighten() {
        const double factor = std::min(0.1, 0.2 * limit_ / std::max(image_.deviation, 0.02 * limit_));
        times_("matrix", [&] { operator_->tighten(std::max(factor, kFinest / operator_->tolerance())); });
        if (image_.uncertainty > 0) check_image(true);
    }

    void check_image(bool stuck) {
        if (!stuck && has_exact_residual()) {
            image_.values = target_;
            add_scaled(image_.values, -1.0, r_);
            residual_ = largest(r_);
            return;
        }
        image_ = times_("check", [&] { return operator_->checked_image(weights_); });
        goal_ = std::clamp(0.9 * (limit_ - image_.uncertainty), 0.1 * limit_, 0.5 * limit_);
        update_residual();
    }

    /// Whether the recurrence's residual can only have drifted by far less than what is asked for: by the rounding of sums
    /// over all pairs. Of the other kernels the image is needed before its projection.
    bool has_exact_residual() const {
        if (system_.kernel != Kernel::screened || !operator_->matrix()->is_exact()) return false;
        double sum = 0;
        for (const double w : weights_) sum += std::abs(w);
        const double largest_term = kernel_value(Kernel::screened, 2.0);
        return kDrift * std::numeric_limits<double>::epsilon() * largest_term * sum < limit_;
    }

    void update_residual() {
        r_ = target_;
        add_scaled(r_, -1.0, image_.values);
        conditions_.project(r_);
        residual_ = largest(r_) + image_.uncertainty;
    }

    const LinearSystem& system_;
    const SolveOptions& options_;
    const Work& work_;
    StageTimes times_;
    double limit_;
    double goal_;  ///< for the recurrence's residual: what the matrix's error leaves of the limit
    double start_ = 0;
    SideConditions conditions_;
    std::shared_ptr<const PreconditionerPattern> pattern_;
    std::shared_ptr<const Preconditioner> preconditioner_;
    std::optional<ProjectedOperator> operator_;
    Vector weights_, target_, r_;
    CheckedImage image_;  ///< of the weights
    double residual_ = 0;
    int iterations_ = 0;
};

}  // namespace

Coefficients solve_iterative(const LinearSystem& system, const SolveOptions& options, const Work& work) {
    work.report("solve", 0);
    IterativeSolver solver(system, options, work);
    solver.run();
    Coefficients c = solver.result();
    if (!(c.residual <= 1e3 * *options.tolerance_mm))
        throw Error(
            ErrorKind::singular_system,
            fmt::format("the iterative solver stopped at a residual of {:.3g} mm after {} iterations; {:.3g} mm were "
                        "asked for. Constraints coincide or contradict each other; the cholesky solver may help",
                        c.residual, c.iterations, *options.tolerance_mm));
    return c;
}

}  // namespace kontur
