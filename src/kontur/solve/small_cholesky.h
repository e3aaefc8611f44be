// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kontur {

/// Leading dimension that a matrix of n rows needs here: the columns' ends are padded to whole vector registers.
constexpr int padded_rows(int n) { return (n + 15) / 16 * 16; }

/// In-place Cholesky factor of an n x n column-major matrix, columns `padded_rows(n)` apart. Only the lower triangle is
/// read; above it and in the padding, which must be finite, anything may be left behind. False when the matrix is not
/// positive definite. For matrices of some hundred rows, in the caller's thread: BLAS would pick other kernels, and so other
/// bytes, from machine to machine.
bool small_cholesky(double* a, int n);

/// Rows n - m ... n - 1 of the inverse of the lower factor `l`, as a row-major m x n matrix.
void last_rows_of_inverse(const double* l, int n, int m, double* rows);

/// Right-hand sides that `small_cholesky_forward` takes at once.
inline constexpr int kForwardSides = 16;

/// X <- L^-1 X, X an n x kForwardSides matrix, row-major, whose rows before `first`, a multiple of 4, are zero. n^2 flops
/// for each side where `first` is 0.
void small_cholesky_forward(const double* l, int n, int first, double* x);

/// x <- L^-T L^-1 x.
void small_cholesky_solve(const double* l, int n, double* x);

}  // namespace kontur
