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

/// How far phi is computed by polynomials; beyond, k itself has to be summed. Distances within what was drawn are 2 at most.
inline constexpr double kScreenedReach = 3;

/// A polynomial in r on [0, kScreenedReach], lowest power first.
using ScreenedPolynomial = std::array<double, 9>;

// Interpolated at Chebyshev's nodes. The matrix and the values are sums of the same polynomial, so its error changes the
// kernel, not how well f keeps what it was told. phi(r) / r^3, wrong by 3e-14 at most:
inline constexpr ScreenedPolynomial kScreenedValue = {
    0.9999999999999701,     -0.093749999998389,    0.006249999985651069,    -0.0003255207840387022, 1.3950807822952578e-05,
    -5.085436131606392e-07, 1.609935369725027e-08, -4.3803479584015824e-10, 8.44371060180062e-12};
// v(r) in 1 - exp(-x) = x (1 - x/2 + r^2 v), x = r/l, from which both phi and its slope follow; wrong by 6e-17 at most.
inline constexpr ScreenedPolynomial kScreenedShared = {
    0.010416666666666609,    -0.0006510416666635435, 3.255208330552062e-05,   -1.3563367100389468e-06, 4.844043551932889e-08,
    -1.5136087543698605e-09, 4.1957319847765e-11,    -1.0201984380597375e-12, 1.8088907880553477e-14};

/// The polynomial is even + r odd, two polynomials in r^2: processors compute them while the root of r^2 is on its way, and
/// half as many of their steps wait for each other. Numbers or vectors of them.
template <class Number>
[[gnu::always_inline]] inline void screened_halves(const ScreenedPolynomial& c, const Number& squared, Number& even,
                                                   Number& odd) {
    odd = c[1] + squared * (c[3] + squared * (c[5] + squared * c[7]));
    even = c[0] + squared * (c[2] + squared * (c[4] + squared * (c[6] + squared * c[8])));
}

/// phi from r and the halves of kScreenedValue. Numbers or vectors of them.
template <class Number>
[[gnu::always_inline]] inline void screened_value(const Number& squared, const Number& r, const Number& even,
                                                  const Number& odd, Number& out) {
    out = (squared * r) * (even + r * odd);
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

/// k(r) for any r, by steps that compilers vectorise: exp(-x) is the 256th power of exp(-x/256), a short series. Wrong by
/// 1e-13 of itself at most; beyond x = 40, where k is 1e-14, it stays what it is there.
[[gnu::always_inline]] inline double screened_kernel_far(double r) {
    constexpr double l = kScreeningLength;
    const double x = r / l < 40 ? r / l : 40, y = x / -256;
    // Taylor's series to the tenth power by Horner's scheme, without a division; |y| < 0.16.
    constexpr double c[] = {1.0 / 2,    1.0 / 6,     1.0 / 24,     1.0 / 120,    1.0 / 720,
                            1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800};
    double power = c[8];
    for (int n = 7; n >= 0; --n) power = c[n] + y * power;
    power = 1 + y * (1 + y * power);
    for (int squaring = 0; squaring < 8; ++squaring) power *= power;
    return 3 * l * l * l * (1 + x) * power;
}

/// k(r) for any r.
inline double screened_kernel(double r) {
    constexpr double l = kScreeningLength;
    return 3 * l * l * l * (1 + r / l) * std::exp(-r / l);
}

/// k'(r) / r for any r.
inline double screened_kernel_slope(double r) { return -3 * kScreeningLength * std::exp(-r / kScreeningLength); }

}  // namespace kontur
