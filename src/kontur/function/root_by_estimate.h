// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/instruction_sets.h"

#if KONTUR_X86_64_LEVEL != 1

namespace kontur {

using Pack8 = double __attribute__((vector_size(8 * sizeof(double)), aligned(sizeof(double))));

/// Roots of numbers from 0 to 1e300, rounded as the processor's own roots are, from AVX-512's estimate of their reciprocals
/// by Goldschmidt's iteration and Markstein's last step (IBM Journal of Research and Development 34, 1990). Intel's
/// processors make more pairs a second by it, 1.6 times as many, since their own roots leave the units idle that multiply;
/// AMD's fewer, .7 to .9 times. The root of 0 is 1e-150.
[[gnu::always_inline]] inline void root_by_estimate(const Pack8& squared, Pack8& root) {
    constexpr double kLeast = 1e-300;
    const Pack8 least = Pack8{} + kLeast;
    Pack8 a, y, g, h, rest;
    asm("vmaxpd %1, %2, %0" : "=v"(a) : "v"(squared), "v"(least));
    asm("vrsqrt14pd %1, %0" : "=v"(y) : "v"(a));
    g = a * y;
    h = 0.5 * y;
#pragma GCC unroll 2
    for (int step = 0; step < 2; ++step) {
        for (int l = 0; l < 8; ++l) rest[l] = __builtin_fma(-g[l], h[l], 0.5);
        for (int l = 0; l < 8; ++l) g[l] = __builtin_fma(g[l], rest[l], g[l]);
        for (int l = 0; l < 8; ++l) h[l] = __builtin_fma(h[l], rest[l], h[l]);
    }
    for (int l = 0; l < 8; ++l) rest[l] = __builtin_fma(-g[l], g[l], a[l]);
    for (int l = 0; l < 8; ++l) root[l] = __builtin_fma(rest[l], h[l], g[l]);
}

/// Whether this processor gains by it.
inline bool gains_by_estimate() {
    static const bool gains = x86_64_level() == 4 && __builtin_cpu_is("intel");
    return gains;
}

}  // namespace kontur

#endif
