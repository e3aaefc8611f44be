// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cxxabi.h>
#include <unistd.h>

#include <optional>
#include <utility>

#include "casters.h"

namespace kontur::python {

/// Calls what may ask for the interpreter's lock. Once the interpreter ends, CPython 3.11 ends a daemon thread that asks for
/// it by unwinding its stack, through what other threads still work on; such a thread sleeps here until the process is gone.
template <class Call>
void or_sleep_at_exit(const Call& call) {
    try {
        call();
    } catch (const abi::__forced_unwind&) {
        while (true) pause();
    }
}

/// Gives up the interpreter's lock for a scope.
class ReleasedLock {
public:
    ReleasedLock() : state_(PyEval_SaveThread()) {}
    ~ReleasedLock() {
        or_sleep_at_exit([this] { PyEval_RestoreThread(state_); });
    }
    ReleasedLock(const ReleasedLock&) = delete;
    ReleasedLock& operator=(const ReleasedLock&) = delete;

private:
    PyThreadState* state_;
};

/// What the caller of a long function hands in: a callable (stage, fraction) and an object with is_set(), which may both be
/// None, and on how many threads to work.
struct Listener {
    py::object progress;
    py::object stop;
    int threads = 0;
};

/// Runs `task` on a thread of its own without the interpreter's lock, while this thread calls `listener.progress`, looks at
/// `listener.stop` and lets Python handle signals every 20 ms. Ctrl-C and an exception of the callback stop the work and
/// are raised from here; `listener.stop` raises CancelledError.
void run_work(const Listener& listener, const std::function<void(const Work&)>& task);

/// The same for work with a result.
template <class Task>
auto run(const Listener& listener, const Task& task) {
    std::optional<decltype(task(Work{}))> result;
    run_work(listener, [&](const Work& work) { result.emplace(task(work)); });
    return std::move(*result);
}

/// For short calls: the result of `task`, computed without the interpreter's lock.
template <class Task>
auto unlocked(const Task& task) {
    const ReleasedLock released;
    return task();
}

}  // namespace kontur::python
