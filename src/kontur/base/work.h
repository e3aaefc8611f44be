// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include "kontur/base/stop.h"

namespace kontur {

/// How a call may work: on how many threads, whom it tells how far it is, and who may stop it. All optional; a
/// default-constructed Work takes the machine's threads, tells nobody and never stops. No result depends on it. Whatever
/// takes longer than 50 ms honours it.
struct Work {
    int threads = 0;  ///< 0: the machine's
    /// Called from the calling thread with the stage's name (static storage) and its done fraction in [0, 1].
    std::function<void(std::string_view stage, double fraction)> callback{};
    StopToken stop{};

    /// The same threads and stop, telling nobody: for a step of a stage.
    Work untold() const { return {threads, {}, stop}; }
    /// Reports, then throws Error(cancelled) if a stop was requested.
    void report(std::string_view stage, double fraction) const;
    /// Throws Error(cancelled) if a stop was requested.
    void check() const;
};

}  // namespace kontur
