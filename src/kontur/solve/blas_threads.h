// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cblas.h>

#include <mutex>

namespace kontur {

/// Holds OpenBLAS to one thread for a scope: its results differ with its own thread count, and its spinning starves ours.
/// The setting is process-wide, so the first of callers side by side makes it and the last one undoes it.
class SingleThreadedBlas {
public:
    SingleThreadedBlas() {
        const std::scoped_lock lock(setting().mutex);
        if (setting().users++ > 0) return;
        setting().before = openblas_get_num_threads();
        openblas_set_num_threads(1);
    }
    ~SingleThreadedBlas() {
        const std::scoped_lock lock(setting().mutex);
        if (--setting().users == 0) openblas_set_num_threads(setting().before);
    }
    SingleThreadedBlas(const SingleThreadedBlas&) = delete;
    SingleThreadedBlas& operator=(const SingleThreadedBlas&) = delete;

private:
    struct Setting {
        std::mutex mutex;
        int users = 0, before = 1;
    };
    static Setting& setting() {
        static Setting setting;
        return setting;
    }
};

}  // namespace kontur
