// SPDX-License-Identifier: Apache-2.0
#include "run.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "kontur/base/stop.h"

namespace kontur::python {
namespace {

constexpr std::chrono::milliseconds kPollInterval{20};

struct Event {
    std::string stage;
    double fraction;
};

/// From the working thread to the waiting one.
class Relay {
public:
    void report(std::string_view stage, double fraction) {
        const std::scoped_lock lock(mutex_);
        events_.push_back({std::string(stage), fraction});
    }
    void finish() {
        {
            const std::scoped_lock lock(mutex_);
            finished_ = true;
        }
        woken_.notify_one();
    }
    /// Waits at most one poll interval; true when the work has ended. Moves what was reported to `events`.
    bool wait(std::vector<Event>& events) {
        std::unique_lock lock(mutex_);
        woken_.wait_for(lock, kPollInterval, [&] { return finished_; });
        std::swap(events, events_);
        return finished_;
    }

private:
    std::mutex mutex_;
    std::condition_variable woken_;
    std::vector<Event> events_;
    bool finished_ = false;
};

/// What Python has to say; throws what it raises.
void attend(const Listener& listener, const std::vector<Event>& events, StopSource& source) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!listener.progress.is_none())
        for (const Event& event : events) listener.progress(event.stage, event.fraction);
    if (!listener.stop.is_none() && py::bool_(listener.stop.attr("is_set")())) source.request_stop();
}

}  // namespace

void run_work(const Listener& listener, const std::function<void(const Work&)>& task) {
    Relay relay;
    StopSource source;
    Work work{.threads = listener.threads, .stop = source.token()};
    if (!listener.progress.is_none())
        work.callback = [&relay](std::string_view stage, double fraction) { relay.report(stage, fraction); };

    std::exception_ptr failure;
    std::thread worker([&] {
        try {
            task(work);
        } catch (...) {
            failure = std::current_exception();
        }
        relay.finish();
    });
    std::optional<py::error_already_set> raised;
    for (bool finished = false; !finished;) {
        std::vector<Event> events;
        {
            const ReleasedLock released;
            finished = relay.wait(events);
        }
        if (raised) continue;
        try {
            or_sleep_at_exit([&] { attend(listener, events, source); });
        } catch (py::error_already_set& error) {
            raised.emplace(error);
            source.request_stop();
        }
    }
    worker.join();
    if (raised) throw py::error_already_set(*raised);
    if (failure) std::rethrow_exception(failure);
}

}  // namespace kontur::python
