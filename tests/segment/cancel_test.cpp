// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <thread>

#include "kontur/base/error.h"
#include "kontur/segment.h"
#include "support/contour_sets.h"
#include "support/random.h"

namespace kontur {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Circles of a ball, enough of them that every stage takes its time.
ContourSet ball() {
    ContourSet set;
    for (int axis = 0; axis < 3; ++axis)
        for (int n = -3; n <= 3; ++n) {
            Vec3 normal;
            normal[axis] = 1;
            set.contours.push_back(
                test::circle(make_plane(10.0 * n * normal, normal), std::sqrt(1600.0 - 100.0 * n * n), 120));
        }
    return set;
}

/// What passes from the request to stop to the return; 0 when the call was done before.
struct Delay {
    double seconds = 0;
    double processor_seconds = 0;  ///< of all threads
};

Delay stop_after(Seconds delay, const ContourSet& set, const Grid& grid, const SegmentOptions& options) {
    StopSource source;
    Clock::time_point asked{};
    std::clock_t processor_asked{};
    std::jthread stopper([&] {
        std::this_thread::sleep_for(delay);
        asked = Clock::now();
        processor_asked = std::clock();
        source.request_stop();
    });
    try {
        segment(set, grid, options, {.stop = source.token()});
    } catch (const Error& error) {
        const Clock::time_point ended = Clock::now();
        const std::clock_t processor_ended = std::clock();
        EXPECT_EQ(name(error.kind()), name(ErrorKind::cancelled)) << error.what();
        stopper.join();
        return {Seconds(ended - asked).count(), double(processor_ended - processor_asked) / CLOCKS_PER_SEC};
    }
    return {};
}

/// Leaks show under AddressSanitizer. Time counts only with KONTUR_TIMED=1, and then the processor's, which other programs
/// lengthen less: on an idle machine the call ends within it.
TEST(Cancellation, AtRandomMomentsEndsTheCall) {
    const ContourSet set = ball();
    const Grid grid = grid_around(bounding_box(set), {0.6, 0.6, 0.6}, 10);
    const SegmentOptions options{.mesh = true};
    const Clock::time_point start = Clock::now();
    const Segmentation whole = segment(set, grid, options);
    const double all = Seconds(Clock::now() - start).count();

    std::mt19937 random = test::random_of_this_test();
    const char* rounds = std::getenv("KONTUR_CANCEL_ROUNDS");
    Delay longest;
    for (int n = rounds ? std::atoi(rounds) : 12; n > 0; --n) {
        const Seconds delay{std::uniform_real_distribution(0.0, all)(random)};
        const Delay one = stop_after(delay, set, grid, options);
        longest.seconds = std::max(longest.seconds, one.seconds);
        longest.processor_seconds = std::max(longest.processor_seconds, one.processor_seconds);
    }
    std::printf("a call of %.2f s ended at most %.3f s, %.3f s of the processors, after it was asked to\n", all,
                longest.seconds, longest.processor_seconds);
    if (std::getenv("KONTUR_TIMED")) {
        EXPECT_LT(longest.processor_seconds, 0.1);
    }
    EXPECT_EQ(segment(set, grid, options).mask.values, whole.mask.values);
}

}  // namespace
}  // namespace kontur
