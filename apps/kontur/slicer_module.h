// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <string_view>

#include "kontur/base/stop.h"
#include "kontur/base/work.h"

namespace kontur::app {

/// The description that 3D Slicer builds a module's panel from. `parameters`: its groups of them, as XML. Source: the schema
/// of its command-line modules, "Slicer Execution Model".
std::string slicer_module_description(std::string_view title, std::string_view purpose, std::string_view parameters);

/// A number of the panel. Its tag is double or integer, its flag --NAME in the words of the command line.
struct SlicerNumber {
    std::string_view tag, name, label, flag, description;
    double value, least, most, step;
};
std::string slicer_number(const SlicerNumber& number);
/// That of --threads.
std::string slicer_threads(int threads);

/// A number that the panel shows after a run.
struct SlicerResult {
    std::string_view tag, name, label, description;
};
/// The group of them.
std::string slicer_results(std::span<const SlicerResult> results);

/// One run of a command-line module, told on stdout by tags: the start, what is done, and the end.
class SlicerRun {
public:
    explicit SlicerRun(std::string_view module);

    /// Stages follow one another without anyone knowing how many are to come: each takes half of what is left of the bar.
    Work work(int threads, const StopToken& stop);
    /// Shown below the bar, and in the log.
    void say(std::string_view sentence);
    void end();

private:
    using Clock = std::chrono::steady_clock;

    void report(std::string_view stage, double fraction);

    const std::string module_;
    const Clock::time_point start_ = Clock::now();
    std::string stage_;
    double done_before_ = 0, done_ = 0;
};

}  // namespace kontur::app
