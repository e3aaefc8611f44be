// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cblas.h>

namespace kontur {

/// Holds OpenBLAS to one thread for a scope: its results differ with its own thread count, and its spinning starves ours.
/// The setting is process-wide, so callers run side by side agree on it.
class SingleThreadedBlas {
public:
    SingleThreadedBlas() : before_(openblas_get_num_threads()) { openblas_set_num_threads(1); }
    ~SingleThreadedBlas() { openblas_set_num_threads(before_); }
    SingleThreadedBlas(const SingleThreadedBlas&) = delete;
    SingleThreadedBlas& operator=(const SingleThreadedBlas&) = delete;

private:
    int before_;
};

}  // namespace kontur
