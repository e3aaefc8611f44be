// SPDX-License-Identifier: Apache-2.0
#include <lapacke.h>

#include "kontur/base/error.h"
#include "kontur/solve/blas_threads.h"
#include "kontur/solve/linear_system.h"

namespace kontur {

Coefficients solve_dense(const LinearSystem& system) {
    const SingleThreadedBlas guard;
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

    std::vector<lapack_int> pivots(n);
    const auto order = static_cast<lapack_int>(n);
    const lapack_int info =
        LAPACKE_dsysv(LAPACK_COL_MAJOR, 'L', order, 1, matrix.data(), order, pivots.data(), right.data(), order);
    if (info < 0) throw Error(ErrorKind::singular_system, "the linear system has entries that are not finite");
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
