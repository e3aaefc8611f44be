// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <thread>

namespace kontur::app {

/// While it lives, the first Ctrl-C (SIGINT) or SIGTERM requests a stop instead of ending the process, so that the command
/// can leave its output folders as they were. The second one ends the process at once. One object at a time.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    std::stop_token token() const { return source_.get_token(); }

private:
    std::stop_source source_;
    std::thread watcher_;
};

}  // namespace kontur::app
