// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/workers.h"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>

namespace kontur {
namespace {

constexpr int kMostThreads = 1024;

// Never destroyed: detached threads wait in it until the process ends.
std::atomic<Workers*> the_workers = nullptr;

}  // namespace

Workers& Workers::instance() {
    static const bool is_set_up = [] {
        the_workers = new Workers;
        pthread_atfork(nullptr, nullptr, [] { the_workers = new Workers; });  // a fork copies no threads
        return true;
    }();
    static_cast<void>(is_set_up);
    return *the_workers;
}

void Workers::run(int helpers, const std::function<void()>& work) {
    if (helpers <= 0) return work();
    Job job{work, helpers};
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(&job);
        try {
            for (; threads_ < std::min(helpers, kMostThreads); ++threads_) std::thread([this] { wait_for_jobs(); }).detach();
        } catch (const std::system_error&) {
            // The system gives no more threads; those there are will do.
        }
    }
    for (int h = 0; h < helpers; ++h) job_added_.notify_one();
    work();
    std::unique_lock lock(mutex_);
    std::erase(jobs_, &job);
    job.ended.wait(lock, [&] { return job.running == 0; });
}

void Workers::wait_for_jobs() {
    std::unique_lock lock(mutex_);
    while (true) {
        job_added_.wait(lock, [&] { return !jobs_.empty(); });
        Job& job = *jobs_.front();
        ++job.running;
        if (--job.wanted == 0) jobs_.pop_front();
        lock.unlock();
        job.work();
        lock.lock();
        if (--job.running == 0) job.ended.notify_one();
    }
}

}  // namespace kontur
