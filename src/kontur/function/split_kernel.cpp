// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/split_kernel.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/instruction_sets.h"
#include "kontur/function/screened_kernel.h"

namespace kontur {
namespace {

using Coefficients = std::array<double, kSplitDegree + 1>;
using Powers = std::array<double, kSplitPowers>;

/// Exponent of q in the lowest odd power of r.
double lowest_exponent(Kernel kernel) { return kernel == Kernel::biharmonic ? 0.5 : 1.5; }

struct Task {
    const NearSources& sources;
    Vec3 target;
    const Powers& powers;
    const Coefficients& polynomial;
    double inverse_radius2;
};

[[gnu::always_inline]] inline double horner(const double* c, double q) {
    return c[0] + q * (c[1] + q * (c[2] + q * (c[3] + q * (c[4] + q * c[5]))));
}

[[gnu::always_inline]] inline double total(const double* lanes) {
    return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

/// The root of q times its odd powers' series.
template <Kernel kKernel>
[[gnu::always_inline]] inline double odd_part(const Powers& powers, double q) {
    const double root = std::sqrt(q);
    if constexpr (kKernel == Kernel::biharmonic) return root;
    if constexpr (kKernel == Kernel::triharmonic) return q * root;
    return q * root * (powers[0] + q * (powers[1] + q * powers[2]));
}

/// Its derivative by q.
template <Kernel kKernel>
[[gnu::always_inline]] inline double odd_slope(const Powers& slopes, double q) {
    const double root = std::sqrt(q);
    if constexpr (kKernel == Kernel::biharmonic) return q > 0 ? 0.5 / root : 0.0;
    if constexpr (kKernel == Kernel::triharmonic) return 1.5 * root;
    return root * (slopes[0] + q * (slopes[1] + q * slopes[2]));
}

// The near part is R^3 (q^(3/2) ... - P(q)) or R (q^(1/2) - P(q)); at q = 1, where distant centres are clamped to, it
// vanishes.
template <Kernel kKernel>
[[gnu::always_inline]] inline double sum_values(const Task& task) {
    const double *x = task.sources.x.data(), *y = task.sources.y.data(), *z = task.sources.z.data(),
                 *w = task.sources.w.data();
    const double tx = task.target.x, ty = task.target.y, tz = task.target.z, scale = task.inverse_radius2;
    const Coefficients p = task.polynomial;
    const Powers powers = task.powers;
    alignas(64) double sum[kNearLanes] = {};
    for (std::size_t j = 0; j < task.sources.x.size(); j += kNearLanes)
        for (std::size_t l = 0; l < kNearLanes; ++l) {
            const double dx = tx - x[j + l], dy = ty - y[j + l], dz = tz - z[j + l];
            const double q2 = (dx * dx + dy * dy + dz * dz) * scale;
            const double q = q2 < 1 ? q2 : 1;
            sum[l] += w[j + l] * (odd_part<kKernel>(powers, q) - horner(p.data(), q));
        }
    return total(sum);
}

template <Kernel kKernel>
[[gnu::always_inline]] inline Vec3 sum_gradients(const Task& task) {
    const double *x = task.sources.x.data(), *y = task.sources.y.data(), *z = task.sources.z.data(),
                 *w = task.sources.w.data();
    const double tx = task.target.x, ty = task.target.y, tz = task.target.z, scale = task.inverse_radius2;
    const Coefficients p = task.polynomial;
    const Powers slopes = task.powers;
    alignas(64) double gx[kNearLanes] = {}, gy[kNearLanes] = {}, gz[kNearLanes] = {};
    for (std::size_t j = 0; j < task.sources.x.size(); j += kNearLanes)
        for (std::size_t l = 0; l < kNearLanes; ++l) {
            const double dx = tx - x[j + l], dy = ty - y[j + l], dz = tz - z[j + l];
            const double q2 = (dx * dx + dy * dy + dz * dz) * scale;
            const double q = q2 < 1 ? q2 : 1;
            const double factor = w[j + l] * (odd_slope<kKernel>(slopes, q) - horner(p.data(), q));
            gx[l] += factor * dx;
            gy[l] += factor * dy;
            gz[l] += factor * dz;
        }
    return {total(gx), total(gy), total(gz)};
}

KONTUR_EVERY_INSTRUCTION_SET double screened_value(const Task& task) { return sum_values<Kernel::screened>(task); }
KONTUR_EVERY_INSTRUCTION_SET double triharmonic_value(const Task& task) { return sum_values<Kernel::triharmonic>(task); }
KONTUR_EVERY_INSTRUCTION_SET double biharmonic_value(const Task& task) { return sum_values<Kernel::biharmonic>(task); }
KONTUR_EVERY_INSTRUCTION_SET Vec3 screened_gradient(const Task& task) { return sum_gradients<Kernel::screened>(task); }
KONTUR_EVERY_INSTRUCTION_SET Vec3 triharmonic_gradient(const Task& task) { return sum_gradients<Kernel::triharmonic>(task); }
KONTUR_EVERY_INSTRUCTION_SET Vec3 biharmonic_gradient(const Task& task) { return sum_gradients<Kernel::biharmonic>(task); }

/// The Taylor polynomial of q^exponent about 1: the sum of binomial(a, m) (q - 1)^m by Horner's scheme, which multiplies by
/// (q - 1) and adds the next binomial.
Coefficients taylor(double exponent) {
    Coefficients binomial{1};
    for (std::size_t m = 1; m < binomial.size(); ++m)
        binomial[m] = binomial[m - 1] * (exponent - static_cast<double>(m - 1)) / static_cast<double>(m);
    Coefficients result{};
    for (std::size_t m = binomial.size(); m-- > 0;) {
        for (std::size_t power = result.size(); power-- > 1;) result[power] = result[power - 1] - result[power];
        result[0] = binomial[m] - result[0];
    }
    return result;
}

}  // namespace

std::array<double, kSplitPowers> odd_powers(Kernel kernel, double radius) {
    if (kernel != Kernel::screened) return {1, 0, 0};
    const double a = radius / kScreeningLength, squared = a * a;
    return {1, squared / 10, squared * squared / 280};
}

Coefficients split_polynomial(Kernel kernel, double radius) {
    const Powers powers = odd_powers(kernel, radius);
    Coefficients result{};
    for (std::size_t n = 0; n < powers.size(); ++n) {
        const Coefficients of_power = taylor(lowest_exponent(kernel) + static_cast<double>(n));
        for (std::size_t m = 0; m < result.size(); ++m) result[m] += powers[n] * of_power[m];
    }
    return result;
}

NearKernel::NearKernel(Kernel kernel, double radius)
    : kernel_(kernel), radius_(radius), powers_(odd_powers(kernel, radius)), polynomial_(split_polynomial(kernel, radius)) {
    for (std::size_t n = 0; n < powers_.size(); ++n)
        power_slopes_[n] = (lowest_exponent(kernel) + static_cast<double>(n)) * powers_[n];
    for (std::size_t m = 1; m < polynomial_.size(); ++m) slope_[m - 1] = static_cast<double>(m) * polynomial_[m];
}

double NearKernel::value(const NearSources& sources, const Vec3& target) const {
    const Task task{sources, target, powers_, polynomial_, 1 / (radius_ * radius_)};
    if (kernel_ == Kernel::biharmonic) return radius_ * biharmonic_value(task);
    return radius_ * radius_ * radius_ * (kernel_ == Kernel::screened ? screened_value(task) : triharmonic_value(task));
}

Vec3 NearKernel::gradient(const NearSources& sources, const Vec3& target) const {
    const Task task{sources, target, power_slopes_, slope_, 1 / (radius_ * radius_)};
    // The chain rule's dq/dx is 2 dx / R^2.
    if (kernel_ == Kernel::biharmonic) return 2 / radius_ * biharmonic_gradient(task);
    return 2 * radius_ * (kernel_ == Kernel::screened ? screened_gradient(task) : triharmonic_gradient(task));
}

}  // namespace kontur
