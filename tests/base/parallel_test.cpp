// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/parallel.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "kontur/base/error.h"

namespace kontur {
namespace {

TEST(ParallelFor, VisitsEveryItemOnceForAnyThreadCount) {
    for (const int threads : {1, 2, 3, 8})
        for (const std::int64_t count : {0, 1, 7, 1000}) {
            std::vector<int> visits(static_cast<std::size_t>(count), 0);
            parallel_for(count, 3, threads, [&](std::int64_t begin, std::int64_t end) {
                for (std::int64_t i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
            });
            for (const int visit : visits) EXPECT_EQ(visit, 1);
        }
}

TEST(ParallelFor, RethrowsABodysException) {
    const auto run = [](int threads) {
        parallel_for(100, 1, threads, [](std::int64_t begin, std::int64_t) {
            if (begin == 42) throw std::runtime_error("42");
        });
    };
    EXPECT_THROW(run(1), std::runtime_error);
    EXPECT_THROW(run(4), std::runtime_error);
}

TEST(ParallelFor, BeginsNoChunkAfterAStop) {
    for (const int threads : {1, 4}) {
        StopSource source;
        std::atomic<int> begun = 0;
        const auto run = [&] {
            parallel_for(100, 1, Work{.threads = threads, .stop = source.token()}, [&](std::int64_t, std::int64_t) {
                ++begun;
                source.request_stop();
            });
        };
        EXPECT_THROW(run(), Error);
        EXPECT_LE(begun, threads);
    }
}

std::int64_t sum_in_parallel(std::int64_t count) {
    std::atomic<std::int64_t> sum = 0;
    parallel_for(count, 1, 4, [&](std::int64_t begin, std::int64_t) { sum += begin; });
    return sum;
}

TEST(ParallelFor, NestsAndServesSeveralThreadsAtOnce) {
    std::atomic<int> right = 0;
    const auto nest = [&] {
        for (int repeat = 0; repeat < 50; ++repeat)
            parallel_for(8, 1, 4, [&](std::int64_t, std::int64_t) { right += sum_in_parallel(20) == 190; });
    };
    {
        std::jthread other(nest), another(nest);
        nest();
    }
    EXPECT_EQ(right, 3 * 50 * 8);
}

TEST(ParallelFor, WorksInAForkedChild) {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "ThreadSanitizer ends the child of a process with threads when it starts some of its own";
#endif
    EXPECT_EQ(sum_in_parallel(100), 4950);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) _exit(sum_in_parallel(100) == 4950 ? 0 : 1);
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

}  // namespace
}  // namespace kontur
