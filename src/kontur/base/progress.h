// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace kontur {

/// What a long call tells its caller and asks of it: a callback for progress and a token for cancellation. Both optional;
/// a default-constructed Progress reports nothing and never stops. Whatever takes longer than 50 ms honours it.
struct Progress {
    /// Called from the calling thread with the stage's name (static storage) and its done fraction in [0, 1].
    std::function<void(std::string_view stage, double fraction)> callback;
    std::stop_token stop;

    /// Reports, then throws Error(cancelled) if a stop was requested.
    void report(std::string_view stage, double fraction) const;
    /// Throws Error(cancelled) if a stop was requested.
    void check() const;
};

}  // namespace kontur
