// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/split_kernel.h"

#include <algorithm>

#include "kontur/base/instruction_sets.h"

namespace kontur {
namespace {

using Coefficients = std::array<double, kSplitDegree + 1>;

/// Exponent of q in phi / R^m.
double exponent(Kernel kernel) { return kernel == Kernel::triharmonic ? 1.5 : 0.5; }

struct Task {
    const NearSources& sources;
    Vec3 target;
    const Coefficients& polynomial;
    double inverse_radius2;
};

[[gnu::always_inline]] inline double horner(const double* c, double q) {
    return c[0] + q * (c[1] + q * (c[2] + q * (c[3] + q * (c[4] + q * c[5]))));
}

[[gnu::always_inline]] inline double total(const double* lanes) {
    return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

// The near part is R^3 (q^(3/2) - P(q)) or R (q^(1/2) - P(q)); at q = 1, where distant centres are clamped to, it vanishes.
template <bool triharmonic>
[[gnu::always_inline]] inline double sum_values(const Task& task) {
    const double *x = task.sources.x.data(), *y = task.sources.y.data(), *z = task.sources.z.data(),
                 *w = task.sources.w.data();
    const double tx = task.target.x, ty = task.target.y, tz = task.target.z, scale = task.inverse_radius2;
    const Coefficients p = task.polynomial;
    alignas(64) double sum[kNearLanes] = {};
    for (std::size_t j = 0; j < task.sources.x.size(); j += kNearLanes)
        for (std::size_t l = 0; l < kNearLanes; ++l) {
            const double dx = tx - x[j + l], dy = ty - y[j + l], dz = tz - z[j + l];
            const double q2 = (dx * dx + dy * dy + dz * dz) * scale;
            const double q = q2 < 1 ? q2 : 1;
            const double root = std::sqrt(q);
            sum[l] += w[j + l] * ((triharmonic ? q * root : root) - horner(p.data(), q));
        }
    return total(sum);
}

template <bool triharmonic>
[[gnu::always_inline]] inline Vec3 sum_gradients(const Task& task) {
    const double *x = task.sources.x.data(), *y = task.sources.y.data(), *z = task.sources.z.data(),
                 *w = task.sources.w.data();
    const double tx = task.target.x, ty = task.target.y, tz = task.target.z, scale = task.inverse_radius2;
    const Coefficients p = task.polynomial;
    alignas(64) double gx[kNearLanes] = {}, gy[kNearLanes] = {}, gz[kNearLanes] = {};
    for (std::size_t j = 0; j < task.sources.x.size(); j += kNearLanes)
        for (std::size_t l = 0; l < kNearLanes; ++l) {
            const double dx = tx - x[j + l], dy = ty - y[j + l], dz = tz - z[j + l];
            const double q2 = (dx * dx + dy * dy + dz * dz) * scale;
            const double q = q2 < 1 ? q2 : 1;
            const double root = std::sqrt(q);
            const double phi_slope = triharmonic ? 1.5 * root : q > 0 ? 0.5 / root : 0.0;
            const double factor = w[j + l] * (phi_slope - horner(p.data(), q));
            gx[l] += factor * dx;
            gy[l] += factor * dy;
            gz[l] += factor * dz;
        }
    return {total(gx), total(gy), total(gz)};
}

KONTUR_EVERY_INSTRUCTION_SET double triharmonic_value(const Task& task) { return sum_values<true>(task); }
KONTUR_EVERY_INSTRUCTION_SET double biharmonic_value(const Task& task) { return sum_values<false>(task); }
KONTUR_EVERY_INSTRUCTION_SET Vec3 triharmonic_gradient(const Task& task) { return sum_gradients<true>(task); }
KONTUR_EVERY_INSTRUCTION_SET Vec3 biharmonic_gradient(const Task& task) { return sum_gradients<false>(task); }

}  // namespace

Coefficients split_polynomial(Kernel kernel) {
    // Sum of binomial(a, m) (q - 1)^m by Horner's scheme: multiply by (q - 1), add the next binomial.
    Coefficients binomial{1};
    for (std::size_t m = 1; m < binomial.size(); ++m)
        binomial[m] = binomial[m - 1] * (exponent(kernel) - static_cast<double>(m - 1)) / static_cast<double>(m);
    Coefficients result{};
    for (std::size_t m = binomial.size(); m-- > 0;) {
        for (std::size_t power = result.size(); power-- > 1;) result[power] = result[power - 1] - result[power];
        result[0] = binomial[m] - result[0];
    }
    return result;
}

NearKernel::NearKernel(Kernel kernel, double radius)
    : kernel_(kernel), radius_(radius), polynomial_(split_polynomial(kernel)) {
    for (std::size_t m = 1; m < polynomial_.size(); ++m) slope_[m - 1] = static_cast<double>(m) * polynomial_[m];
}

double NearKernel::value(const NearSources& sources, const Vec3& target) const {
    const Task task{sources, target, polynomial_, 1 / (radius_ * radius_)};
    return kernel_ == Kernel::triharmonic ? radius_ * radius_ * radius_ * triharmonic_value(task)
                                          : radius_ * biharmonic_value(task);
}

Vec3 NearKernel::gradient(const NearSources& sources, const Vec3& target) const {
    const Task task{sources, target, slope_, 1 / (radius_ * radius_)};
    // The chain rule's dq/dx is 2 dx / R^2.
    return kernel_ == Kernel::triharmonic ? 2 * radius_ * triharmonic_gradient(task)
                                          : 2 / radius_ * biharmonic_gradient(task);
}

}  // namespace kontur
