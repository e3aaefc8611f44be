// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

namespace kontur {

struct StopState;

/// Says whether work shall end early. A default-constructed one never says so. Cheap to copy; safe to read from any thread.
/// These three are for std::stop_token, std::stop_source and std::stop_callback, which libc++ lacks before version 20.
class StopToken {
public:
    StopToken() = default;
    bool stop_requested() const noexcept;

private:
    friend class StopSource;
    friend class StopCallback;
    explicit StopToken(std::shared_ptr<StopState> state) : state_(std::move(state)) {}

    std::shared_ptr<StopState> state_;
};

/// Requests that work ends early. Copies stand for the same request, which nobody takes back. Safe from any thread.
class StopSource {
public:
    StopSource();
    /// The first request runs the callbacks of its tokens, one by one, before it returns.
    void request_stop() const;
    bool stop_requested() const noexcept { return token().stop_requested(); }
    StopToken token() const noexcept { return StopToken(state_); }

private:
    std::shared_ptr<StopState> state_;
};

/// Runs a function once, on the thread that requests the stop, or at once where the stop is requested already. Its end waits
/// until the function has returned. The function must not throw, nor end a StopCallback of the same token.
class StopCallback {
public:
    StopCallback(StopToken token, std::function<void()> function);
    ~StopCallback();
    StopCallback(const StopCallback&) = delete;
    StopCallback& operator=(const StopCallback&) = delete;

private:
    StopToken token_;
    std::function<void()> function_;
};

}  // namespace kontur
