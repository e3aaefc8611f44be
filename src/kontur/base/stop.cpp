// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/stop.h"

#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

namespace kontur {

struct StopState {
    std::atomic<bool> is_requested = false;
    std::mutex mutex;                                   ///< held while functions run: a callback's end waits for them
    std::vector<const std::function<void()>*> waiting;  ///< guarded by the mutex
};

bool StopToken::stop_requested() const noexcept { return state_ && state_->is_requested.load(std::memory_order_acquire); }

StopSource::StopSource() : state_(std::make_shared<StopState>()) {}

void StopSource::request_stop() const {
    // Kept alive: a function may let its holder drop the source.
    const std::shared_ptr<StopState> state = state_;
    if (state->is_requested.exchange(true, std::memory_order_acq_rel)) return;
    const std::lock_guard lock(state->mutex);
    for (const auto* function : std::exchange(state->waiting, {})) (*function)();
}

StopCallback::StopCallback(StopToken token, std::function<void()> function)
    : token_(std::move(token)), function_(std::move(function)) {
    if (!token_.state_) return;
    if (!token_.stop_requested()) {
        const std::lock_guard lock(token_.state_->mutex);
        if (!token_.stop_requested()) {
            token_.state_->waiting.push_back(&function_);
            return;
        }
    }
    function_();
}

StopCallback::~StopCallback() {
    if (!token_.state_) return;
    const std::lock_guard lock(token_.state_->mutex);
    std::erase(token_.state_->waiting, &function_);
}

}  // namespace kontur
