// SPDX-License-Identifier: Apache-2.0
#include "runs.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "kontur/base/parallel.h"

namespace kontur::bench {
namespace {

constexpr double kEnoughSeconds = 10;

using Stages = std::vector<std::pair<std::string, double>>;

double total(const Stages& stages) {
    return std::accumulate(stages.begin(), stages.end(), 0.0,
                           [](double sum, const Stages::value_type& stage) { return sum + stage.second; });
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Timing measure(int repeat, const std::function<void()>& work) {
    std::vector<double> seconds;
    do seconds.push_back(seconds_of(work));
    while (static_cast<int>(seconds.size()) < repeat &&
           std::accumulate(seconds.begin(), seconds.end(), 0.0) < kEnoughSeconds);
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>((seconds.size() - 1) / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    return {*middle, static_cast<int>(seconds.size())};
}

TimedSegmentation segment_repeatedly(int repeat, const std::function<Segmentation()>& segment_once) {
    TimedSegmentation result;
    std::vector<Stages> runs;
    const Timing timing = measure(repeat, [&] {
        result.segmentation = {};  // its memory must not count for the next run
        result.segmentation = segment_once();
        runs.push_back(result.segmentation.report.seconds);
    });
    const auto middle = runs.begin() + static_cast<std::ptrdiff_t>((runs.size() - 1) / 2);
    std::nth_element(runs.begin(), middle, runs.end(), [](const Stages& a, const Stages& b) { return total(a) < total(b); });
    result.segmentation.report.seconds = *middle;
    result.seconds = total(*middle);
    result.runs = timing.runs;
    return result;
}

std::vector<int> thread_counts() {
    const int all = thread_count(0);
    return all == 1 ? std::vector{1} : std::vector{1, all};
}

}  // namespace kontur::bench
