// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace kontur {

/// Collects the wall time of consecutive stages, in seconds.
class Stopwatch {
public:
    explicit Stopwatch(std::vector<std::pair<std::string, double>>& laps) : laps_(laps) {}
    void lap(const char* stage) {
        const auto now = Clock::now();
        laps_.emplace_back(stage, std::chrono::duration<double>(now - last_).count());
        last_ = now;
    }

private:
    using Clock = std::chrono::steady_clock;
    std::vector<std::pair<std::string, double>>& laps_;
    Clock::time_point last_ = Clock::now();
};

}  // namespace kontur
