// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

namespace kontur {

/// Threads that wait for work. Starting a thread takes longer than many a parallel loop.
class Workers {
public:
    /// The process's own; a forked child has its own again.
    static Workers& instance();

    /// Runs `work`, which must not throw, on the calling thread and on up to `helpers` others; returns when all that began
    /// it have ended. Workers that are busy elsewhere are not waited for.
    void run(int helpers, const std::function<void()>& work);

private:
    struct Job {
        const std::function<void()>& work;
        int wanted;       ///< workers that may still join
        int running = 0;  ///< workers that have joined and not ended
        std::condition_variable ended = {};
    };

    void wait_for_jobs();

    std::mutex mutex_;
    std::condition_variable job_added_;
    std::deque<Job*> jobs_;  ///< all want workers
    int threads_ = 0;
};

}  // namespace kontur
