// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/projected_operator.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/solve/solver_setup.h"

namespace kontur {
namespace {

constexpr std::size_t kSamples = 4000;        // of the points, where the values of an H2 matrix are checked
constexpr double kElsewhere = 1.15;           // times the largest error at these, the largest anywhere; measured: 1.11
constexpr std::size_t kSamplesPerStep = 256;  // between looks at the progress

}  // namespace

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

SideConditions::SideConditions(const LinearSystem& system) : system_(system) {
    if (system.kernel == Kernel::screened) return;
    const PointArrays& centers = system.centers;
    basis_ = {Vector(centers.size(), 1.0), centers.x, centers.y, centers.z};
    for (std::size_t m = 0; m < 4; ++m) {
        const double before = std::sqrt(inner(basis_[m], basis_[m]));
        for (int pass = 0; pass < 2; ++pass)  // twice is enough for orthogonality to rounding
            for (std::size_t k = 0; k < m; ++k) add_scaled(basis_[m], -inner(basis_[m], basis_[k]), basis_[k]);
        const double length = std::sqrt(inner(basis_[m], basis_[m]));
        if (!(length > 1e-9 * std::max(before, 1.0)))
            throw Error(ErrorKind::singular_system, "all constraints lie in one plane, so the surface is not determined");
        for (double& v : basis_[m]) v /= length;
    }
}

void SideConditions::project(Vector& v) const {
    for (const Vector& q : basis_) add_scaled(v, -inner(v, q), q);
    for (std::size_t i = 0; i < v.size(); ++i)
        if (system_.is_left_out(i)) v[i] = 0;
}

ProjectedOperator::ProjectedOperator(const LinearSystem& system, const SideConditions& conditions, double tolerance,
                                     const SolveOptions& options, const Work& work)
    : system_(system), conditions_(conditions), tolerance_(tolerance), options_(options), work_(work) {
    if (!system.setup || system.setup->matrix->is_exact()) {
        tighten(1);
    } else {
        tolerance_ = system.setup->matrix_tolerance;
        matrix_ = std::make_shared<BorderedKernelMatrix>(system.kernel, system.setup->matrix, system.centers, work);
    }
}

void ProjectedOperator::tighten(double factor) {
    tolerance_ *= factor;
    matrix_.reset();  // the memory of one is enough
    matrix_ = make_kernel_matrix(system_.kernel, system_.centers, options_.products, tolerance_, work_);
}

Vector ProjectedOperator::image(const KernelMatrix& matrix, const Vector& w) const {
    Vector out(w.size());
    matrix.multiply(w, out);
    add_even_powers(system_.kernel, system_.centers, w, out);
    const double sign = kernel_sign(system_.kernel);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = sign * out[i] + system_.smoothing[i] * w[i];
    return out;
}

Vector ProjectedOperator::operator()(const Vector& w) const {
    Vector out = image(*matrix_, w);
    conditions_.project(out);
    return out;
}

CheckedImage ProjectedOperator::checked_image(const Vector& w) const {
    const std::size_t n = w.size();
    CheckedImage result{image(*matrix_, w), 0, 0, n};
    if (matrix_->is_exact()) return result;
    if (n <= kSamples) {
        Vector exact = image(DirectKernelMatrix(system_.kernel, system_.centers, work_), w);
        for (std::size_t i = 0; i < n; ++i)
            result.deviation = std::max(result.deviation, std::abs(result.values[i] - exact[i]));
        result.values = std::move(exact);
    } else {
        result.checked = kSamples;
        result.deviation = result.uncertainty = kElsewhere * sampled_deviation(w, result.values, kSamples);
    }
    return result;
}

double ProjectedOperator::sampled_deviation(const Vector& w, const Vector& image, std::size_t samples) const {
    const double sign = kernel_sign(system_.kernel);
    const EvenPowers powers = system_.kernel == Kernel::screened ? even_powers(system_.centers, w) : EvenPowers{};
    double largest = 0;
    for (std::size_t begin = 0; begin < samples; begin += kSamplesPerStep) {
        work_.check();
        std::vector<std::size_t> points;
        std::vector<Vec3> positions;
        for (std::size_t s = begin; s < std::min(samples, begin + kSamplesPerStep); ++s) {
            points.push_back(s * w.size() / samples);
            positions.push_back(system_.centers[points.back()]);
        }
        Vector exact(points.size());
        sum_kernel({system_.kernel, system_.centers, w}, PointArrays(positions), exact, work_);
        for (std::size_t s = 0; s < points.size(); ++s) {
            const double sum = exact[s] + powers.value(positions[s]);
            const double value = sign * sum + system_.smoothing[points[s]] * w[points[s]];
            largest = std::max(largest, std::abs(value - image[points[s]]));
        }
    }
    return largest;
}

}  // namespace kontur
