// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "kontur/base/checks.h"
#include "kontur/base/workers.h"

namespace kontur {

int thread_count(int requested) {
    check_threads(requested);
    if (requested > 0) return requested;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::int64_t count, std::int64_t chunk, int threads,
                  const std::function<void(std::int64_t, std::int64_t)>& body) {
    if (count <= 0) return;
    chunk = std::max<std::int64_t>(chunk, 1);
    const std::int64_t chunks = (count + chunk - 1) / chunk;

    std::atomic<std::int64_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&] {
        for (std::int64_t c = next++; c < chunks; c = next++) {
            try {
                body(c * chunk, std::min(count, (c + 1) * chunk));
            } catch (...) {
                const std::lock_guard lock(failure_mutex);
                if (!failure) failure = std::current_exception();
                next = chunks;
            }
        }
    };

    Workers::instance().run(static_cast<int>(std::min<std::int64_t>(thread_count(threads), chunks)) - 1, work);
    if (failure) std::rethrow_exception(failure);
}

void parallel_for(std::int64_t count, std::int64_t chunk, const Work& work,
                  const std::function<void(std::int64_t, std::int64_t)>& body) {
    parallel_for(count, chunk, work.threads, [&](std::int64_t begin, std::int64_t end) {
        work.check();
        body(begin, end);
    });
}

}  // namespace kontur
