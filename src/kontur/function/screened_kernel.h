// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace kontur {

// The screened triharmonic kernel k(r) = 3 l^3 (1 + r/l) exp(-r/l), which is Matern's with smoothness 3/2 (Rasmussen &
// Williams 2006, 4.2.1). In space it is the fundamental solution of (1/l^2 - Laplace)^3 up to a factor, as r^3 is that of
// Laplace^3, and
//
//     k(r) = 3 l^3 - 1.5 l r^2 + phi(r),   phi(r) = r^3 (1 - 3/8 r/l + 1/10 (r/l)^2 - ...),
//
// so near its centres it is r^3, and far from them it is 0. Of the sums of k only phi has to be summed pair by pair: the
// even powers before it are polynomials of the target whose coefficients are moments of the weights. phi is no larger than
// r^3, so sums of it lose no more digits to cancellation.

/// l in the unit frame, in which all that was drawn lies in the unit ball.
inline constexpr double kScreeningLength = 4;

/// How far phi is computed by polynomials; beyond, k itself has to be summed.
inline constexpr double kScreenedReach = 4;

/// A polynomial in r on [0, kScreenedReach], lowest power first.
using ScreenedPolynomial = std::array<double, 11>;

// Interpolated at Chebyshev's nodes. phi(r) / r^3, wrong by 2e-16 at most:
inline constexpr ScreenedPolynomial kScreenedValue = {
    0.9999999999999999,     -0.09374999999999126,    0.00624999999991248,   -0.00032552083299102077,
    1.3950892169437119e-05, -5.086254944525408e-07,  1.614627370964609e-08, -4.538497001899607e-10,
    1.1381777381842787e-11, -2.4613691295991155e-13, 3.620065707727142e-15};
// v(r) in 1 - exp(-x) = x (1 - x/2 + r^2 v), x = r/l, from which both phi and its slope follow; wrong by 3e-17 of itself.
inline constexpr ScreenedPolynomial kScreenedShared = {
    0.010416666666666666,   -0.0006510416666666523,  3.255208333318913e-05,  -1.356336804991643e-06,
    4.844059906589327e-08,  -1.5137674268438262e-09, 4.2048156704317946e-11, -1.0507667239571731e-12,
    2.3750209418128708e-14, -4.704737312069835e-16,  6.49236880370724e-18};

/// The polynomial is even + r odd, two polynomials in r^2: processors compute them while the root of r^2 is on its way, and
/// half as many of their steps wait for each other. Numbers or vectors of them.
template <class Number>
[[gnu::always_inline]] inline void screened_halves(const ScreenedPolynomial& c, const Number& squared, Number& even,
                                                   Number& odd) {
    odd = c[1] + squared * (c[3] + squared * (c[5] + squared * (c[7] + squared * c[9])));
    even = c[0] + squared * (c[2] + squared * (c[4] + squared * (c[6] + squared * (c[8] + squared * c[10]))));
}

/// phi from r and the halves of kScreenedValue. Numbers or vectors of them.
template <class Number>
[[gnu::always_inline]] inline void screened_value(const Number& squared, const Number& r, const Number& even,
                                                  const Number& odd, Number& out) {
    out = (squared * r) * even + (squared * squared) * odd;
}

/// phi / r^3 and phi' / (3 r^2) at once.
[[gnu::always_inline]] inline void screened_factors(double squared, double r, double& value, double& slope) {
    constexpr double l = kScreeningLength;
    double even, odd;
    screened_halves(kScreenedShared, squared, even, odd);
    const double v = even + r * odd;
    value = 1.5 - (3 * l * l + 3 * l * r) * v;
    slope = 1 - r / (2 * l) + squared * v;
}

/// k(r) for any r.
inline double screened_kernel(double r) {
    constexpr double l = kScreeningLength;
    return 3 * l * l * l * (1 + r / l) * std::exp(-r / l);
}

/// k'(r) / r for any r.
inline double screened_kernel_slope(double r) { return -3 * kScreeningLength * std::exp(-r / kScreeningLength); }

}  // namespace kontur
