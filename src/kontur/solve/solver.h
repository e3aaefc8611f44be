// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

enum class Solver {
    automatic,  ///< iterative
    iterative,  ///< projected conjugate gradients, sparse inverse Cholesky preconditioner: O(n) memory
    cholesky,   ///< polynomials projected out, dense Cholesky: n^3/3 flops, 4 n^2 bytes
    dense,      ///< the symmetric indefinite system of Eq. 6 by LAPACK dsysv, as printed in the paper: 8 n^2 bytes
};
std::string_view name(Solver solver) noexcept;

}  // namespace kontur
