// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/small_cholesky.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kontur/base/instruction_sets.h"

namespace kontur {
namespace {

// Tiles of two packs by kPanel columns stay in registers, which compilers do not achieve from plain loops.
constexpr int kLanes = 4;  // wider types than AVX2's are broken into single numbers there, twenty times slower
using Pack = double __attribute__((vector_size(kLanes * sizeof(double)), aligned(sizeof(double)), may_alias));

constexpr int kPanel = 16;  // columns that are factorised before they update the others
constexpr int kTile = 4;    // columns that are updated together

double* column(double* a, int lead, int j) { return a + static_cast<std::ptrdiff_t>(j) * lead; }
const double* column(const double* a, int lead, int j) { return a + static_cast<std::ptrdiff_t>(j) * lead; }
Pack& pack(double* a) { return *reinterpret_cast<Pack*>(a); }
const Pack& pack(const double* a) { return *reinterpret_cast<const Pack*>(a); }

/// Factorises columns [begin, end), whose earlier updates are done.
KONTUR_EVERY_INSTRUCTION_SET bool factorise_panel(double* a, int n, int lead, int begin, int end) {
    for (int j = begin; j < end; ++j) {
        double* cj = column(a, lead, j);
        if (!(cj[j] > 0)) return false;
        const double inverse = 1 / std::sqrt(cj[j]);
        for (int i = j; i < n; ++i) cj[i] *= inverse;
        for (int k = j + 1; k < end; ++k) {
            double* ck = column(a, lead, k);
            const double f = cj[k];
            for (int i = k / kLanes * kLanes; i < lead; i += kLanes) pack(ck + i) -= f * pack(cj + i);
        }
    }
    return true;
}

/// Subtracts the panel's outer product from columns [first, first + kTile) from row `first` on.
KONTUR_EVERY_INSTRUCTION_SET void update_tile(double* a, int lead, int panel, int first) {
    for (int i = first / (2 * kLanes) * (2 * kLanes); i < lead; i += 2 * kLanes) {
        Pack upper[kTile], lower[kTile];
        for (int c = 0; c < kTile; ++c) {
            upper[c] = pack(column(a, lead, first + c) + i);
            lower[c] = pack(column(a, lead, first + c) + i + kLanes);
        }
        for (int p = panel; p < panel + kPanel; ++p) {
            const double* source = column(a, lead, p);
            const Pack u = pack(source + i), l = pack(source + i + kLanes);
#pragma GCC unroll 4
            for (int c = 0; c < kTile; ++c) {
                const double f = source[first + c];
                upper[c] -= f * u;
                lower[c] -= f * l;
            }
        }
        for (int c = 0; c < kTile; ++c) {
            pack(column(a, lead, first + c) + i) = upper[c];
            pack(column(a, lead, first + c) + i + kLanes) = lower[c];
        }
    }
}

/// The same for a single column.
KONTUR_EVERY_INSTRUCTION_SET void update_column(double* a, int lead, int panel, int k) {
    double* target = column(a, lead, k);
    for (int p = panel; p < panel + kPanel; ++p) {
        const double* source = column(a, lead, p);
        const double f = source[k];
        for (int i = k / kLanes * kLanes; i < lead; i += kLanes) pack(target + i) -= f * pack(source + i);
    }
}

}  // namespace

bool small_cholesky(double* a, int n) {
    const int lead = padded_rows(n);
    for (int begin = 0; begin < n; begin += kPanel) {
        const int end = std::min(n, begin + kPanel);
        if (!factorise_panel(a, n, lead, begin, end)) return false;
        int k = end;
        for (; k + kTile <= n; k += kTile) update_tile(a, lead, begin, k);
        for (; k < n; ++k) update_column(a, lead, begin, k);
    }
    return true;
}

namespace {

struct Factor {
    const double* l;
    int n, lead;
};

/// Columns j - kTile + 1 ... j of G from those behind them, for kPacks packs of rows; see last_rows_of_inverse.
template <int kPacks>
[[gnu::always_inline]] inline void subtract_later(const Factor& factor, int j, double* g, int stride) {
    const int first = j - kTile + 1;
    Pack sum[kTile][kPacks];
    for (int c = 0; c < kTile; ++c)
        for (std::ptrdiff_t p = 0; p < kPacks; ++p)
            sum[c][p] = pack(g + static_cast<std::ptrdiff_t>(first + c) * stride + p * kLanes);
    for (int k = j + 1; k < factor.n; ++k) {
        const double* gk = g + static_cast<std::ptrdiff_t>(k) * stride;
#pragma GCC unroll 4
        for (int c = 0; c < kTile; ++c) {
            const double f = column(factor.l, factor.lead, first + c)[k];
#pragma GCC unroll 4
            for (std::ptrdiff_t p = 0; p < kPacks; ++p) sum[c][p] -= f * pack(gk + p * kLanes);
        }
    }
    for (int c = 0; c < kTile; ++c)
        for (std::ptrdiff_t p = 0; p < kPacks; ++p)
            pack(g + static_cast<std::ptrdiff_t>(first + c) * stride + p * kLanes) = sum[c][p];
}

}  // namespace

KONTUR_EVERY_INSTRUCTION_SET void last_rows_of_inverse(const double* l, int n, int m, double* rows) {
    // G L = [0 I] from the last column back: g_j = (e_j - sum_{k > j} g_k l_kj) / l_jj, for all m rows at once.
    const int lead = padded_rows(n), stride = (m + kLanes - 1) / kLanes * kLanes;
    std::vector<double> all(static_cast<std::size_t>(n) * stride, 0.0);  // column j holds the m entries of g_j
    double* g = all.data();
    for (int r = 0; r < m; ++r) column(g, stride, n - m + r)[r] = 1;
    for (int end = n; end > 0; end -= kTile) {
        const int begin = std::max(0, end - kTile);
        int p = 0;
        if (end - begin == kTile) {
            for (; p + 4 * kLanes <= stride; p += 4 * kLanes) subtract_later<4>({l, n, lead}, end - 1, g + p, stride);
            for (; p < stride; p += kLanes) subtract_later<1>({l, n, lead}, end - 1, g + p, stride);
        }
        for (int j = end - 1; j >= begin; --j) {
            double* gj = column(g, stride, j);
            const double* lj = column(l, lead, j);
            for (int k = j + 1; k < (end - begin == kTile ? end : n); ++k)
                for (int r = 0; r < stride; r += kLanes) pack(gj + r) -= lj[k] * pack(column(g, stride, k) + r);
            const double inverse = 1 / lj[j];
            for (int r = 0; r < stride; r += kLanes) pack(gj + r) *= inverse;
        }
    }
    for (int r = 0; r < m; ++r)
        for (int j = 0; j < n; ++j) rows[static_cast<std::ptrdiff_t>(r) * n + j] = column(g, stride, j)[r];
}

KONTUR_EVERY_INSTRUCTION_SET void small_cholesky_forward(const double* l, int n, int first, double* x) {
    constexpr int kPacks = kForwardSides / kLanes;
    const int lead = padded_rows(n);
    const auto row = [x](int i) { return x + static_cast<std::ptrdiff_t>(i) * kForwardSides; };
    for (int begin = first; begin < n; begin += kTile) {
        const int end = std::min(n, begin + kTile);
        Pack sum[kTile][kPacks] = {};
        for (int k = first; k < begin; ++k) {
            const double* lk = column(l, lead, k) + begin;  // behind the last row is padding, which counts for nothing
#pragma GCC unroll 4
            for (int c = 0; c < kTile; ++c)
#pragma GCC unroll 4
                for (int p = 0; p < kPacks; ++p) sum[c][p] += lk[c] * pack(row(k) + p * kLanes);
        }
        for (int i = begin; i < end; ++i) {
            const double inverse = 1 / column(l, lead, i)[i];
            for (int p = 0; p < kPacks; ++p) {
                Pack value = pack(row(i) + p * kLanes) - sum[i - begin][p];
                for (int k = begin; k < i; ++k) value -= column(l, lead, k)[i] * pack(row(k) + p * kLanes);
                pack(row(i) + p * kLanes) = value * inverse;
            }
        }
    }
}

KONTUR_EVERY_INSTRUCTION_SET void small_cholesky_solve(const double* l, int n, double* x) {
    const int lead = padded_rows(n);
    for (int j = 0; j < n; ++j) {
        const double* lj = column(l, lead, j);
        x[j] /= lj[j];
        const double f = x[j];
        for (int i = j + 1; i < n; ++i) x[i] -= f * lj[i];
    }
    for (int j = n - 1; j >= 0; --j) {
        const double* lj = column(l, lead, j);
        double sum = x[j];
        for (int i = j + 1; i < n; ++i) sum -= lj[i] * x[i];
        x[j] = sum / lj[j];
    }
}

}  // namespace kontur
