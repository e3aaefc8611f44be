// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/stencil.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace kontur {
namespace {

StencilValues sample(const auto& f) {
    StencilValues nodes;
    std::size_t next = 0;
    for (int k = -3; k <= 4; ++k)
        for (int j = -3; j <= 4; ++j)
            for (int i = -3; i <= 4; ++i) nodes[next++] = f(Vec3{1.0 * i, 1.0 * j, 1.0 * k});
    return nodes;
}

TEST(Stencil, ReproducesPolynomialsOfDegreeSevenAlongEachAxis) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> fraction(0, 1);
    for (int a = 0; a <= 7; ++a)
        for (int b = 0; b <= 7; b += 7 - a % 2)
            for (const int c : {0, 3, 7}) {
                const auto f = [&](const Vec3& p) {
                    return std::pow(p.x / 4, a) * std::pow(p.y / 4, b) * std::pow(p.z / 4, c);
                };
                const StencilValues nodes = sample(f);
                const Vec3 at{fraction(random), fraction(random), fraction(random)};
                EXPECT_NEAR(interpolate(nodes, at), f(at), 1e-13);
                const Vec3 gradient = interpolate_gradient(nodes, at);
                for (int axis = 0; axis < 3; ++axis) {
                    const double h = 1e-5;
                    Vec3 low = at, high = at;
                    low[axis] -= h;
                    high[axis] += h;
                    EXPECT_NEAR(gradient[axis], (f(high) - f(low)) / (2 * h), 1e-8);
                }
            }
}

TEST(Stencil, PassesThroughTheCornersOfTheCell) {
    const StencilValues nodes = sample([](const Vec3& p) { return std::sin(p.x + 2 * p.y - 3 * p.z); });
    for (int n = 0; n < 8; ++n) {
        const Vec3 corner{1.0 * (n & 1), 1.0 * (n >> 1 & 1), 1.0 * (n >> 2)};
        EXPECT_NEAR(interpolate(nodes, corner), std::sin(corner.x + 2 * corner.y - 3 * corner.z), 1e-15);
    }
}

}  // namespace
}  // namespace kontur
