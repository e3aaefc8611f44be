// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace kontur {

/// In-place Cholesky factor of an n x n column-major matrix with leading dimension `lead`; only the lower triangle is read
/// and written. False when the matrix is not positive definite. For matrices of some hundred rows, in the caller's thread:
/// BLAS would pick other kernels, and so other bytes, from machine to machine.
bool small_cholesky(double* a, int n, int lead);

/// Rows n - m ... n - 1 of the inverse of the lower factor `l`, as a row-major m x n matrix.
void last_rows_of_inverse(const double* l, int n, int lead, int m, double* rows);

/// x <- L^-T L^-1 x.
void small_cholesky_solve(const double* l, int n, int lead, double* x);

}  // namespace kontur
