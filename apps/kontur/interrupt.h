// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <csignal>
#include <thread>

#include "kontur/base/stop.h"

namespace kontur::app {

/// Ignored by this program, but not by those that it starts.
inline constexpr std::array kIgnoredSignals{SIGXFSZ, SIGPIPE};

/// While it lives, the first Ctrl-C (SIGINT), SIGTERM or SIGHUP (a closed terminal, unless nohup has it ignored) requests a
/// stop instead of ending the process, so that the command can leave its output folders as they were. The second one ends
/// the process at once. One object at a time.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    StopToken token() const { return source_.token(); }

private:
    StopSource source_;
    std::thread watcher_;
};

}  // namespace kontur::app
