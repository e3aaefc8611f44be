// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "kontur/base/error.h"
#include "kontur/field/kernel_matrix.h"
#include "kontur/field/linear_system.h"
#include "kontur/field/preconditioner.h"

namespace kontur {
namespace {

using Vector = std::vector<double>;

double inner(const Vector& a, const Vector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

void add_scaled(Vector& a, double s, const Vector& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += s * b[i];
}

double largest(const Vector& a) {
    double result = 0;
    for (const double v : a) result = std::max(result, std::abs(v));
    return result;
}

/// An orthonormal basis of the linear polynomials' values at the centres.
class LinearPolynomials {
public:
    explicit LinearPolynomials(const PointArrays& centers) {
        basis_ = {Vector(centers.size(), 1.0), centers.x, centers.y, centers.z};
        for (std::size_t m = 0; m < 4; ++m) {
            const double before = std::sqrt(inner(basis_[m], basis_[m]));
            for (int pass = 0; pass < 2; ++pass)  // twice is enough for orthogonality to rounding
                for (std::size_t k = 0; k < m; ++k) add_scaled(basis_[m], -inner(basis_[m], basis_[k]), basis_[k]);
            const double length = std::sqrt(inner(basis_[m], basis_[m]));
            if (!(length > 1e-9 * std::max(before, 1.0)))
                throw Error(ErrorKind::singular_system,
                            "all constraints lie in one plane, so the surface is not determined");
            for (double& v : basis_[m]) v /= length;
        }
    }

    /// Removes the best linear fit.
    void project_out(Vector& v) const {
        for (const Vector& q : basis_) add_scaled(v, -inner(v, q), q);
    }

private:
    std::array<Vector, 4> basis_;
};

/// sign (Phi + diagonal) on the weights that satisfy the side conditions; definite there.
class ProjectedOperator {
public:
    ProjectedOperator(const LinearSystem& system, const LinearPolynomials& polynomials, int threads)
        : system_(system), polynomials_(polynomials), matrix_(make_kernel_matrix(system.kernel, system.centers, threads)) {}

    /// sign (Phi + diagonal) w, not projected.
    Vector unprojected(const Vector& w) const {
        Vector out(w.size());
        matrix_->multiply(w, out);
        const double sign = kernel_sign(system_.kernel);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = sign * out[i] + system_.smoothing * w[i];
        return out;
    }
    Vector operator()(const Vector& w) const {
        Vector out = unprojected(w);
        polynomials_.project_out(out);
        return out;
    }

private:
    const LinearSystem& system_;
    const LinearPolynomials& polynomials_;
    std::unique_ptr<KernelMatrix> matrix_;
};

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

}  // namespace

Coefficients solve_iterative(const LinearSystem& system, const SolveOptions& options, const Progress& progress) {
    const LinearPolynomials polynomials(system.centers);
    const ProjectedOperator apply(system, polynomials, options.threads);
    const double sign = kernel_sign(system.kernel);
    progress.report("solve", 0);
    const Preconditioner preconditioner(
        system.kernel,
        std::make_shared<PreconditionerPattern>(system.centers, PreconditionerOptions{}, options.threads, progress),
        system.smoothing, options.threads, progress);
    const auto precondition = [&](const Vector& r) {
        Vector z(r.size());
        preconditioner.apply(r, z);
        polynomials.project_out(z);
        return z;
    };

    Coefficients c;
    c.weights.assign(system.size(), 0.0);
    c.matrix_mb = preconditioner.megabytes();
    Vector r = system.values;
    for (double& v : r) v *= sign;
    const Vector target = r;
    polynomials.project_out(r);
    const double start = std::max(largest(r), options.tolerance_mm);
    double reached = largest(r);
    Vector image(system.size());  // of the weights

    // The recurrence's residual drifts from the true one: at the end it is computed afresh, and the iteration restarted
    // from there as long as that helps.
    for (double before = std::numeric_limits<double>::infinity();
         reached > options.tolerance_mm && reached < 0.5 * before;) {
        before = reached;
        Vector z = precondition(r), direction = z;
        double rz = inner(r, z);
        while (largest(r) > 0.5 * options.tolerance_mm && c.iterations < options.max_iterations && rz > 0) {
            const Vector step = apply(direction);
            const double curvature = inner(direction, step);
            if (!(curvature > 0)) break;  // rounding has taken over
            add_scaled(c.weights, rz / curvature, direction);
            add_scaled(r, -rz / curvature, step);
            z = precondition(r);
            const double next = inner(r, z);
            for (std::size_t i = 0; i < z.size(); ++i) direction[i] = z[i] + next / rz * direction[i];
            rz = next;
            ++c.iterations;
            const double done =
                std::log(start / std::max(largest(r), options.tolerance_mm)) / std::log(start / options.tolerance_mm + 1e-9);
            progress.report("solve", std::clamp(done, 0.0, 1.0));
        }
        polynomials.project_out(c.weights);
        image = apply.unprojected(c.weights);
        r = target;
        add_scaled(r, -1.0, image);
        polynomials.project_out(r);
        reached = largest(r);
    }
    if (!(reached <= 1e3 * options.tolerance_mm))
        throw Error(ErrorKind::singular_system,
                    "the iterative solver stopped at a residual of " + std::to_string(reached) + " mm after " +
                        std::to_string(c.iterations) + " iterations; the limit is " + std::to_string(options.tolerance_mm) +
                        " mm. Constraints coincide or contradict each other; the cholesky solver may help");

    c.residual = reached;
    Vector left = system.values;
    add_scaled(left, -sign, image);
    c.polynomial = fit_linear(system, left);
    return c;
}

}  // namespace kontur
