// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/solve/blas.h"
#include "kontur/solve/linear_system.h"

namespace kontur {
namespace {

constexpr std::size_t kTile = 256;

/// The lower triangle of a symmetric matrix as square column-major tiles; the last row of tiles may be short.
class TiledMatrix {
public:
    explicit TiledMatrix(std::size_t n)
        : n_(n), tiles_((n + kTile - 1) / kTile), data_(tiles_ * (tiles_ + 1) / 2 * kTile * kTile) {}

    std::size_t tiles() const { return tiles_; }
    std::size_t begin(std::size_t t) const { return t * kTile; }
    int rows(std::size_t t) const { return static_cast<int>(std::min(kTile, n_ - t * kTile)); }
    double* tile(std::size_t row, std::size_t column) {
        return data_.data() + (row * (row + 1) / 2 + column) * kTile * kTile;
    }
    double megabytes() const { return static_cast<double>(data_.size()) * 8 / (1 << 20); }

private:
    std::size_t n_, tiles_;
    std::vector<double> data_;
};

constexpr int kLead = static_cast<int>(kTile);

/// The weights that satisfy the side conditions, parametrised by those of all centres but four.
struct ReducedBasis {
    std::array<std::size_t, 4> spread;
    std::vector<std::size_t> rest;                 ///< all other centres
    std::vector<std::array<double, 4>> lagrange;   ///< l_m at each of `rest`
    std::vector<std::array<double, 4>> to_spread;  ///< entry(spread_m, rest_i)
    std::array<std::array<double, 4>, 4> among;    ///< entry(spread_m, spread_k)

    explicit ReducedBasis(const LinearSystem& system) : spread(spread_centers(system.centers)) {
        std::array<std::array<double, 4>, 4> basis;
        for (std::size_t m = 0; m < 4; ++m) {
            std::array<double, 4> one{};
            one[m] = 1;
            basis[m] = linear_through(system.centers, spread, one);
            for (std::size_t k = 0; k < 4; ++k) among[m][k] = system.entry(spread[m], spread[k]);
        }
        for (std::size_t i = 0; i < system.size(); ++i) {
            if (std::find(spread.begin(), spread.end(), i) != spread.end()) continue;
            rest.push_back(i);
            const Vec3 p = system.centers[i];
            auto& l = lagrange.emplace_back();
            auto& e = to_spread.emplace_back();
            for (std::size_t m = 0; m < 4; ++m) {
                l[m] = basis[m][0] + basis[m][1] * p.x + basis[m][2] * p.y + basis[m][3] * p.z;
                e[m] = system.entry(spread[m], i);
            }
        }
    }

    /// (B^T Phi B)_ij.
    double entry(const LinearSystem& system, std::size_t i, std::size_t j) const {
        double sum = system.entry(rest[i], rest[j]);
        for (std::size_t m = 0; m < 4; ++m) {
            double inner = 0;
            for (std::size_t k = 0; k < 4; ++k) inner += among[m][k] * lagrange[j][k];
            sum += lagrange[i][m] * (inner - to_spread[j][m]) - lagrange[j][m] * to_spread[i][m];
        }
        return sum;
    }
};

/// `entry(i, j)` is symmetric; the lower triangle is wanted.
template <class Entry>
void fill(TiledMatrix& a, const Entry& entry, const Work& work) {
    parallel_for(static_cast<std::int64_t>(a.tiles()), 1, work, [&](std::int64_t first, std::int64_t last) {
        for (auto row = static_cast<std::size_t>(first); row < static_cast<std::size_t>(last); ++row)
            for (std::size_t column = 0; column <= row; ++column) {
                double* tile = a.tile(row, column);
                for (int j = 0; j < a.rows(column); ++j)
                    for (int i = row == column ? j : 0; i < a.rows(row); ++i)
                        tile[i + j * kLead] =
                            entry(a.begin(row) + static_cast<std::size_t>(i), a.begin(column) + static_cast<std::size_t>(j));
            }
    });
}

bool has_nan(const double* tile, int rows) {
    for (int j = 0; j < rows; ++j)
        for (int i = j; i < rows; ++i)
            if (std::isnan(tile[i + j * kLead])) return true;
    return false;
}

void factorise(const SingleThreadedBlas& blas, TiledMatrix& a, const Work& work) {
    for (std::size_t k = 0; k < a.tiles(); ++k) {
        work.report("solve", static_cast<double>(k) / static_cast<double>(a.tiles()));
        const int nk = a.rows(k);
        if (has_nan(a.tile(k, k), nk))
            throw Error(ErrorKind::singular_system, "the reduced system has entries that are not finite");
        int info = 0;
        blas->dpotrf("L", &nk, a.tile(k, k), &kLead, &info, 1);
        if (info > 0)
            throw Error(ErrorKind::singular_system, "the reduced system is not positive definite at row " +
                                                        std::to_string(a.begin(k) + static_cast<std::size_t>(info)) +
                                                        "; constraints coincide or contradict each other");
        const auto below = static_cast<std::int64_t>(a.tiles() - k - 1);
        parallel_for(below, 1, work, [&](std::int64_t first, std::int64_t last) {
            for (auto i = k + 1 + static_cast<std::size_t>(first); i < k + 1 + static_cast<std::size_t>(last); ++i)
                blas->dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, a.rows(i), nk, 1.0,
                            a.tile(k, k), kLead, a.tile(i, k), kLead);
        });
        // Tile (i, j) of the trailing triangle, numbered row by row.
        parallel_for(below * (below + 1) / 2, 1, work, [&](std::int64_t first, std::int64_t last) {
            for (std::int64_t t = first; t < last; ++t) {
                auto r = static_cast<std::int64_t>((std::sqrt(8.0 * static_cast<double>(t) + 1) - 1) / 2);
                while (r * (r + 1) / 2 > t) --r;
                while ((r + 1) * (r + 2) / 2 <= t) ++r;
                const auto i = k + 1 + static_cast<std::size_t>(r);
                const auto j = k + 1 + static_cast<std::size_t>(t - r * (r + 1) / 2);
                if (i == j)
                    blas->dsyrk(CblasColMajor, CblasLower, CblasNoTrans, a.rows(i), nk, -1.0, a.tile(i, k), kLead, 1.0,
                                a.tile(i, i), kLead);
                else
                    blas->dgemm(CblasColMajor, CblasNoTrans, CblasTrans, a.rows(i), a.rows(j), nk, -1.0, a.tile(i, k), kLead,
                                a.tile(j, k), kLead, 1.0, a.tile(i, j), kLead);
            }
        });
    }
}

void substitute(const SingleThreadedBlas& blas, TiledMatrix& a, std::vector<double>& x) {
    for (std::size_t k = 0; k < a.tiles(); ++k) {
        for (std::size_t j = 0; j < k; ++j)
            blas->dgemv(CblasColMajor, CblasNoTrans, a.rows(k), a.rows(j), -1.0, a.tile(k, j), kLead, &x[a.begin(j)], 1, 1.0,
                        &x[a.begin(k)], 1);
        blas->dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, a.rows(k), a.tile(k, k), kLead, &x[a.begin(k)],
                    1);
    }
    for (std::size_t k = a.tiles(); k-- > 0;) {
        for (std::size_t i = k + 1; i < a.tiles(); ++i)
            blas->dgemv(CblasColMajor, CblasTrans, a.rows(i), a.rows(k), -1.0, a.tile(i, k), kLead, &x[a.begin(i)], 1, 1.0,
                        &x[a.begin(k)], 1);
        blas->dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, a.rows(k), a.tile(k, k), kLead, &x[a.begin(k)], 1);
    }
}

/// The polynomial is what is left of the values at the spread centres.
std::array<double, 4> polynomial_of(const LinearSystem& system, const ReducedBasis& basis,
                                    const std::vector<double>& weights) {
    std::array<double, 4> left;
    for (std::size_t m = 0; m < 4; ++m) {
        left[m] = system.values[basis.spread[m]];
        for (std::size_t j = 0; j < system.size(); ++j) left[m] -= system.entry(basis.spread[m], j) * weights[j];
    }
    return linear_through(system.centers, basis.spread, left);
}

Coefficients solve_definite(const SingleThreadedBlas& blas, const LinearSystem& system, const Work& work) {
    TiledMatrix matrix(system.size());
    fill(
        matrix, [&](std::size_t i, std::size_t j) { return system.entry(i, j); }, work);
    factorise(blas, matrix, work);
    Coefficients c;
    c.weights = system.values;
    substitute(blas, matrix, c.weights);
    c.matrix_mb = matrix.megabytes();
    return c;
}

}  // namespace

Coefficients solve_cholesky(const LinearSystem& system, const Work& work) {
    const SingleThreadedBlas blas;
    if (system.kernel == Kernel::screened) return solve_definite(blas, system, work);
    const double sign = kernel_sign(system.kernel);
    const ReducedBasis basis(system);
    TiledMatrix matrix(basis.rest.size());
    fill(
        matrix, [&](std::size_t i, std::size_t j) { return sign * basis.entry(system, i, j); }, work);
    factorise(blas, matrix, work);

    std::vector<double> v(basis.rest.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        v[i] = system.values[basis.rest[i]];
        for (std::size_t m = 0; m < 4; ++m) v[i] -= basis.lagrange[i][m] * system.values[basis.spread[m]];
        v[i] *= sign;
    }
    if (!v.empty()) substitute(blas, matrix, v);

    Coefficients c;
    c.weights.assign(system.size(), 0.0);
    for (std::size_t i = 0; i < v.size(); ++i) {
        c.weights[basis.rest[i]] = v[i];
        for (std::size_t m = 0; m < 4; ++m) c.weights[basis.spread[m]] -= basis.lagrange[i][m] * v[i];
    }
    c.polynomial = polynomial_of(system, basis, c.weights);
    c.matrix_mb = matrix.megabytes();
    return c;
}

}  // namespace kontur
