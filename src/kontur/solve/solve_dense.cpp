// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/solve/blas.h"
#include "kontur/solve/linear_system.h"

namespace kontur {

Coefficients solve_dense(const LinearSystem& system) {
    const SingleThreadedBlas blas;
    const std::size_t polynomials = system.kernel == Kernel::screened ? 0 : 4;
    const std::size_t k = system.size(), n = k + polynomials;
    std::vector<double> matrix(n * n, 0.0);  // column major; dsysv reads the lower triangle
    for (std::size_t j = 0; j < k; ++j) {
        double* column = matrix.data() + j * n;
        for (std::size_t i = j; i < k; ++i) column[i] = system.entry(i, j);
        if (polynomials == 0) continue;
        column[k] = 1;
        column[k + 1] = system.centers.x[j];
        column[k + 2] = system.centers.y[j];
        column[k + 3] = system.centers.z[j];
    }
    std::vector<double> right = system.values;
    right.resize(n, 0.0);

    const auto is_nan = [](double v) { return std::isnan(v); };
    if (std::ranges::any_of(matrix, is_nan) || std::ranges::any_of(right, is_nan))
        throw Error(ErrorKind::singular_system, "the linear system has entries that are not finite");

    std::vector<int> pivots(n);
    const auto order = static_cast<int>(n);
    const int one = 1, ask = -1;
    int info = 0;
    double best_size = 0;
    const auto solve = [&](double* work, const int* work_size) {
        blas->dsysv("L", &order, &one, matrix.data(), &order, pivots.data(), right.data(), &order, work, work_size, &info,
                    1);
    };
    solve(&best_size, &ask);
    const auto work_size = static_cast<int>(best_size);
    std::vector<double> work(static_cast<std::size_t>(work_size));
    solve(work.data(), &work_size);
    if (info > 0)
        throw Error(ErrorKind::singular_system, "the linear system is singular (dsysv stopped at pivot " +
                                                    std::to_string(info) + " of " + std::to_string(n) + ")");

    Coefficients c;
    for (std::size_t m = 0; m < polynomials; ++m) c.polynomial[m] = right[k + m];
    right.resize(k);
    c.weights = std::move(right);
    c.matrix_mb = static_cast<double>(n) * static_cast<double>(n) * 8 / (1 << 20);
    return c;
}

}  // namespace kontur
