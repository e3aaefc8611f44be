// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cblas.h>

#include <cstddef>

namespace kontur {

/// What the reference solvers call of OpenBLAS. Matrices are column-major.
struct BlasRoutines {
    decltype(&cblas_dgemm) dgemm;
    decltype(&cblas_dgemv) dgemv;
    decltype(&cblas_dsyrk) dsyrk;
    decltype(&cblas_dtrsm) dtrsm;
    decltype(&cblas_dtrsv) dtrsv;
    /// LAPACK's, which do not look for NaN; the last arguments are the lengths of the texts.
    void (*dpotrf)(const char* triangle, const int* n, double* a, const int* lead, int* info, std::size_t);
    void (*dsysv)(const char* triangle, const int* n, const int* columns, double* a, const int* lead, int* pivots, double* b,
                  const int* b_lead, double* work, const int* work_size, int* info, std::size_t);
    decltype(&openblas_get_num_threads) get_num_threads;
    decltype(&openblas_set_num_threads) set_num_threads;
};

/// OpenBLAS on one thread for a scope: its results differ with its own thread count, and its spinning starves ours.
/// The setting is process-wide, so the first of callers side by side makes it and the last one undoes it.
///
/// The library is loaded with the first scope: the iterative solver has no use for it, and its threads start with it.
class SingleThreadedBlas {
public:
    /// Throws Error(unsupported) where the library is not to be found.
    SingleThreadedBlas();
    ~SingleThreadedBlas();
    SingleThreadedBlas(const SingleThreadedBlas&) = delete;
    SingleThreadedBlas& operator=(const SingleThreadedBlas&) = delete;

    const BlasRoutines* operator->() const { return &routines_; }

private:
    const BlasRoutines& routines_;
};

}  // namespace kontur
