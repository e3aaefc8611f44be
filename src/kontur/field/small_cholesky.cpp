// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/small_cholesky.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kontur/base/instruction_sets.h"

namespace kontur {
namespace {

constexpr int kPanel = 8;

double* column(double* a, int lead, int j) { return a + static_cast<std::ptrdiff_t>(j) * lead; }
const double* column(const double* a, int lead, int j) { return a + static_cast<std::ptrdiff_t>(j) * lead; }

/// Factorises columns [begin, end), whose earlier updates are done.
KONTUR_EVERY_INSTRUCTION_SET bool factorise_panel(double* a, int n, int lead, int begin, int end) {
    for (int j = begin; j < end; ++j) {
        double* cj = column(a, lead, j);
        if (!(cj[j] > 0)) return false;
        const double inverse = 1 / std::sqrt(cj[j]);
        for (int i = j; i < n; ++i) cj[i] *= inverse;
        for (int k = j + 1; k < end; ++k) {
            double* __restrict ck = column(a, lead, k);
            const double f = cj[k];
            for (int i = k; i < n; ++i) ck[i] -= f * cj[i];
        }
    }
    return true;
}

/// target[i] -= sum_p f[p] * panel_p[i] for a full panel of 8 columns.
KONTUR_EVERY_INSTRUCTION_SET void subtract_panel(double* __restrict target, const double* const* panel, const double* f,
                                                 int begin, int end) {
    const double *p0 = panel[0], *p1 = panel[1], *p2 = panel[2], *p3 = panel[3], *p4 = panel[4], *p5 = panel[5],
                 *p6 = panel[6], *p7 = panel[7];
    for (int i = begin; i < end; ++i)
        target[i] -= ((f[0] * p0[i] + f[1] * p1[i]) + (f[2] * p2[i] + f[3] * p3[i])) +
                     ((f[4] * p4[i] + f[5] * p5[i]) + (f[6] * p6[i] + f[7] * p7[i]));
}

}  // namespace

bool small_cholesky(double* a, int n, int lead) {
    for (int begin = 0; begin < n; begin += kPanel) {
        const int end = std::min(n, begin + kPanel);
        if (!factorise_panel(a, n, lead, begin, end)) return false;
        if (end - begin < kPanel) break;
        const double* panel[kPanel];
        for (int p = 0; p < kPanel; ++p) panel[p] = column(a, lead, begin + p);
        for (int k = end; k < n; ++k) {
            double f[kPanel];
            for (int p = 0; p < kPanel; ++p) f[p] = panel[p][k];
            subtract_panel(column(a, lead, k), panel, f, k, n);
        }
    }
    return true;
}

KONTUR_EVERY_INSTRUCTION_SET void last_rows_of_inverse(const double* l, int n, int lead, int m, double* rows) {
    // G L = [0 I] from the last column back: g_j = (e_j - sum_{k > j} g_k l_kj) / l_jj, for all m rows at once.
    std::vector<double> g(static_cast<std::size_t>(n) * m, 0.0);  // column major: column j holds the m entries of g_j
    for (int j = n - 1; j >= 0; --j) {
        double* __restrict gj = g.data() + static_cast<std::ptrdiff_t>(j) * m;
        if (j >= n - m) gj[j - (n - m)] = 1;
        const double* lj = column(l, lead, j);
        for (int k = j + 1; k < n; ++k) {
            const double f = lj[k];
            const double* __restrict gk = g.data() + static_cast<std::ptrdiff_t>(k) * m;
            for (int r = 0; r < m; ++r) gj[r] -= f * gk[r];
        }
        const double inverse = 1 / lj[j];
        for (int r = 0; r < m; ++r) gj[r] *= inverse;
    }
    for (int r = 0; r < m; ++r)
        for (int j = 0; j < n; ++j) rows[static_cast<std::ptrdiff_t>(r) * n + j] = g[static_cast<std::size_t>(j) * m + r];
}

KONTUR_EVERY_INSTRUCTION_SET void small_cholesky_solve(const double* l, int n, int lead, double* x) {
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
