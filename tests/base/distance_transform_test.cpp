// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/distance_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kontur/phantom/random.h"

namespace kontur {
namespace {

Vec3 place(const Index3& size, std::size_t offset) {
    const auto n = static_cast<std::int64_t>(offset);
    return {static_cast<double>(n % size.i), static_cast<double>(n / size.i % size.j),
            static_cast<double>(n / (size.i * size.j))};
}

TEST(DistanceTransform, IsTheNearestOfAll) {
    Random random(11);
    for (const Index3 size : {Index3{1, 1, 1}, Index3{7, 1, 1}, Index3{1, 9, 4}, Index3{8, 7, 5}, Index3{5, 6, 11}})
        for (const double share : {0.02, 0.2, 0.7}) {
            std::vector<std::uint8_t> marked(static_cast<std::size_t>(size.i * size.j * size.k));
            for (std::uint8_t& mark : marked) mark = random.uniform(0, 1) < share;
            marked[marked.size() / 2] = 1;
            const DistanceTransform found = distance_transform(size, marked);
            for (std::size_t n = 0; n < marked.size(); ++n) {
                double least = std::numeric_limits<double>::infinity();
                for (std::size_t m = 0; m < marked.size(); ++m)
                    if (marked[m]) least = std::min(least, distance(place(size, n), place(size, m)));
                EXPECT_FLOAT_EQ(found.distances[n], static_cast<float>(least));
                EXPECT_TRUE(marked[found.nearest[n]]);
                EXPECT_NEAR(distance(place(size, n), place(size, found.nearest[n])), least, 1e-9);
            }
        }
}

TEST(DistanceTransform, IsInfinitelyFarWhereNoneIs) {
    for (const float steps : distance_transform({3, 2, 2}, std::vector<std::uint8_t>(12)).distances)
        EXPECT_EQ(steps, std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace kontur
