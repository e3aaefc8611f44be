// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/blas.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <mutex>

#include "kontur/base/error.h"

namespace kontur {
namespace {

[[noreturn]] void refuse() {
    throw Error(
        ErrorKind::unsupported,
        fmt::format("the solvers cholesky and dense need OpenBLAS, which cannot be loaded ({}); the solver iterative "
                    "does without it",
                    dlerror()));
}

template <class Routine>
void find(void* library, const char* name, Routine& routine) {
    routine = reinterpret_cast<Routine>(dlsym(library, name));
    if (!routine) refuse();
}

BlasRoutines load() {
    void* library = dlopen(KONTUR_OPENBLAS, RTLD_NOW | RTLD_LOCAL);
    if (!library) refuse();
    BlasRoutines r{};
    find(library, "cblas_dgemm", r.dgemm);
    find(library, "cblas_dgemv", r.dgemv);
    find(library, "cblas_dsyrk", r.dsyrk);
    find(library, "cblas_dtrsm", r.dtrsm);
    find(library, "cblas_dtrsv", r.dtrsv);
    find(library, "dpotrf_", r.dpotrf);
    find(library, "dsysv_", r.dsysv);
    find(library, "openblas_get_num_threads", r.get_num_threads);
    find(library, "openblas_set_num_threads", r.set_num_threads);
    return r;
}

const BlasRoutines& routines() {
    static const BlasRoutines routines = load();
    return routines;
}

struct ThreadSetting {
    std::mutex mutex;
    int users = 0, before = 1;
};

ThreadSetting& setting() {
    static ThreadSetting setting;
    return setting;
}

}  // namespace

SingleThreadedBlas::SingleThreadedBlas() : routines_(routines()) {
    const std::scoped_lock lock(setting().mutex);
    if (setting().users++ > 0) return;
    setting().before = routines_.get_num_threads();
    routines_.set_num_threads(1);
}

SingleThreadedBlas::~SingleThreadedBlas() {
    const std::scoped_lock lock(setting().mutex);
    if (--setting().users == 0) routines_.set_num_threads(setting().before);
}

}  // namespace kontur
