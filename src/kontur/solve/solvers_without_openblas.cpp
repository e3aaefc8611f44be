// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/error.h"
#include "kontur/solve/linear_system.h"

namespace kontur {
namespace {

[[noreturn]] void refuse() {
    throw Error(
        ErrorKind::unsupported,
        "the solvers cholesky and dense need OpenBLAS, without which this kontur was built; the solver iterative does "
        "without it");
}

}  // namespace

Coefficients solve_dense(const LinearSystem&) { refuse(); }

Coefficients solve_cholesky(const LinearSystem&, const Work&) { refuse(); }

}  // namespace kontur
