// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

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

}  // namespace
}  // namespace kontur
