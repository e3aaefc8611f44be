// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/stop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <thread>
#include <vector>

namespace kontur {
namespace {

TEST(Stop, ATokenWithoutASourceNeverStops) {
    int calls = 0;
    const StopToken token;
    {
        const StopCallback callback(token, [&] { ++calls; });
        EXPECT_FALSE(token.stop_requested());
    }
    EXPECT_EQ(calls, 0);
}

TEST(Stop, CopiesStandForOneRequest) {
    const StopSource source, other;
    const StopSource copy = source;
    const StopToken token = source.token();
    EXPECT_FALSE(token.stop_requested());
    copy.request_stop();
    EXPECT_TRUE(token.stop_requested());
    EXPECT_TRUE(source.stop_requested());
    EXPECT_FALSE(other.stop_requested());
}

TEST(Stop, ATokenOutlivesItsSource) {
    std::optional<StopSource> source(std::in_place);
    const StopToken token = source->token();
    source->request_stop();
    source.reset();
    EXPECT_TRUE(token.stop_requested());
}

TEST(Stop, CallbacksRunOnceAndInTheirTime) {
    const StopSource source;
    std::vector<int> calls;
    const StopCallback first(source.token(), [&] { calls.push_back(1); });
    {
        const StopCallback ended(source.token(), [&] { calls.push_back(2); });
    }
    source.request_stop();
    EXPECT_EQ(calls, std::vector{1});
    source.request_stop();
    EXPECT_EQ(calls, std::vector{1});
    const StopCallback late(source.token(), [&] { calls.push_back(3); });
    EXPECT_EQ(calls, (std::vector{1, 3}));
}

TEST(Stop, OneRequestPassesOnAnother) {
    const StopSource outer, inner;
    const StopCallback passing(outer.token(), [&] { inner.request_stop(); });
    outer.request_stop();
    EXPECT_TRUE(inner.stop_requested());
}

TEST(Stop, AFunctionSeesTheRequestAndMayDropTheSource) {
    std::optional<StopSource> source(std::in_place);
    bool seen = false;
    const StopCallback callback(source->token(), [&, token = source->token()] {
        seen = token.stop_requested();
        source.reset();
    });
    source->request_stop();
    EXPECT_TRUE(seen);
    EXPECT_FALSE(source);
}

/// What ThreadSanitizer looks at: callbacks begin and end while another thread requests the stop. A callback that has ended
/// runs no more, so that what its function refers to may go.
TEST(Stop, CallbacksEndWhileAnotherThreadRequests) {
    std::atomic<int> runs = 0;
    int before = 0;
    for (int round = 0; round < 300; ++round) {
        const StopSource source;
        std::thread requester([&] { source.request_stop(); });
        while (!source.stop_requested()) {
            auto alive = std::make_unique<int>(0);
            const StopCallback callback(source.token(), [&] { ++*alive, ++runs; });
        }
        {
            int calls = 0;
            const StopCallback late(source.token(), [&] { ++calls; });
            EXPECT_EQ(calls, 1);
        }
        requester.join();
        before += runs.exchange(0);
    }
    EXPECT_GT(before, 0) << "no stop met a callback: the test shows nothing";
}

}  // namespace
}  // namespace kontur
