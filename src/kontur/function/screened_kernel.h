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

// phi(r) / r^3 and phi'(r) / (3 r^2) on [0, kScreenedReach] as polynomials in r, lowest power first: interpolated at
// Chebyshev's nodes, wrong by 2e-16 and 7e-16 at most.
inline constexpr std::array<double, 11> kScreenedValue = {
    0.9999999999999999,     -0.09374999999999126,    0.00624999999991248,   -0.00032552083299102077,
    1.3950892169437119e-05, -5.086254944525408e-07,  1.614627370964609e-08, -4.538497001899607e-10,
    1.1381777381842787e-11, -2.4613691295991155e-13, 3.620065707727142e-15};
inline constexpr std::array<double, 11> kScreenedSlope = {
    0.9999999999999993,    -0.12499999999996034,    0.010416666666269435,   -0.0006510416651126557,
    3.255208021027005e-05, -1.3563331360548157e-06, 4.8437903824347227e-08, -1.512490056304901e-09,
    4.165626135012856e-11, -9.750051880966e-13,     1.5185188752594563e-14};

/// The polynomial at r; numbers or vectors of them.
template <class Number>
[[gnu::always_inline]] inline void screened_factor(const std::array<double, 11>& c, const Number& r, Number& out) {
    out = c[9] + r * c[10];
    for (std::size_t m = 9; m-- > 0;) out = c[m] + r * out;
}

/// k(r) for any r.
inline double screened_kernel(double r) {
    constexpr double l = kScreeningLength;
    return 3 * l * l * l * (1 + r / l) * std::exp(-r / l);
}

/// k'(r) / r for any r.
inline double screened_kernel_slope(double r) { return -3 * kScreeningLength * std::exp(-r / kScreeningLength); }

}  // namespace kontur
