// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "kontur/segment.h"

namespace kontur::bench {

struct Timing {
    double seconds = 0;  ///< median wall time
    double cpu_seconds =
        0;  ///< median over the same runs of the time of all threads; other work on the machine hardly shows
    int runs = 0;
};

/// Calls `work` up to `repeat` times, but not again once 10 s are spent on it.
Timing measure(int repeat, const std::function<void()>& work);

struct TimedSegmentation {
    Segmentation segmentation;  ///< its report has the stages' times of the run whose total is the median
    Timing timing;
};

/// Segments as often as `measure` would.
TimedSegmentation segment_repeatedly(int repeat, const std::function<Segmentation()>& segment_once);

/// The contour in the middle of the list, moved within its plane as by a hand.
ContourSet dragged(ContourSet set, int edit);

/// 1 and the machine's number of threads.
std::vector<int> thread_counts();

}  // namespace kontur::bench
