// SPDX-License-Identifier: Apache-2.0
#include "runs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
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

double cpu_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double wall_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

template <typename Value, typename Less = std::less<>>
Value median(std::vector<Value> values, Less less = {}) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end(), less);
    return *middle;
}

}  // namespace

Timing measure(int repeat, const std::function<void()>& work) {
    std::vector<double> wall, cpu;
    do {
        const double wall_before = wall_now(), cpu_before = cpu_now();
        work();
        wall.push_back(wall_now() - wall_before);
        cpu.push_back(cpu_now() - cpu_before);
    } while (static_cast<int>(wall.size()) < repeat && std::accumulate(wall.begin(), wall.end(), 0.0) < kEnoughSeconds);
    return {median(wall), median(cpu), static_cast<int>(wall.size())};
}

TimedSegmentation segment_repeatedly(int repeat, const std::function<Segmentation()>& segment_once) {
    TimedSegmentation result;
    std::vector<Stages> runs;
    result.timing = measure(repeat, [&] {
        result.segmentation = {};  // its memory must not count for the next run
        result.segmentation = segment_once();
        runs.push_back(result.segmentation.report.seconds);
    });
    result.segmentation.report.seconds = median(runs, [](const Stages& a, const Stages& b) { return total(a) < total(b); });
    return result;
}

ContourSet dragged(ContourSet set, int edit) {
    constexpr double kDragMm = 4;
    Contour& contour = set.contours[set.contours.size() / 2];
    const Vec3 by = kDragMm * std::sin(0.5 * edit) * contour.plane.u;
    contour.plane.origin += by;
    for (Vec3& p : contour.points) p += by;
    return set;
}

std::vector<int> thread_counts() {
    const int all = thread_count(0);
    return all == 1 ? std::vector{1} : std::vector{1, all};
}

}  // namespace kontur::bench
