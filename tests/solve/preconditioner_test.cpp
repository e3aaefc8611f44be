// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/preconditioner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "kontur/base/error.h"
#include "kontur/solve/linear_system.h"
#include "kontur/solve/nearest_points.h"
#include "kontur/solve/solve.h"
#include "support/random.h"

namespace kontur {
namespace {

PointArrays random_points(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    return PointArrays(points);
}

/// sign (Phi + diagonal) w by plain loops.
std::vector<double> matrix_times(Kernel kernel, const PointArrays& points, double diagonal, const std::vector<double>& w) {
    std::vector<double> result(w.size());
    for (std::size_t i = 0; i < w.size(); ++i) {
        result[i] = diagonal * w[i];
        for (std::size_t j = 0; j < w.size(); ++j) {
            const double r = distance(points[i], points[j]);
            const double phi = kernel == Kernel::screened ? screened_kernel(r) : kernel_value(kernel, r);
            result[i] += kernel_sign(kernel) * phi * w[j];
        }
    }
    return result;
}

/// Random weights whose zeroth and first moments vanish: four of them carry what the others are short of.
std::vector<double> admissible_weights(const PointArrays& points, std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::vector<double> w(points.size());
    for (double& v : w) v = normal(random);
    const std::array<std::size_t, 4> spread = spread_centers(points);
    for (const std::size_t s : spread) w[s] = 0;
    std::array<double, 4> carried{};
    for (std::size_t m = 0; m < 4; ++m) {
        std::array<double, 4> one{};
        one[m] = 1;
        const std::array<double, 4> l = linear_through(points, spread, one);
        for (std::size_t i = 0; i < w.size(); ++i)
            carried[m] += w[i] * (l[0] + l[1] * points.x[i] + l[2] * points.y[i] + l[3] * points.z[i]);
    }
    for (std::size_t m = 0; m < 4; ++m) w[spread[m]] = -carried[m];
    return w;
}

TEST(SpreadCenters, CarryEveryLinearPolynomial) {
    std::mt19937 random = test::random_of_this_test();
    const PointArrays points = random_points(100, random);
    const std::array<std::size_t, 4> spread = spread_centers(points);
    std::array<double, 4> values;
    for (std::size_t m = 0; m < 4; ++m)
        values[m] = 2 + 3 * points.x[spread[m]] - points.y[spread[m]] + 0.5 * points.z[spread[m]];
    const std::array<double, 4> p = linear_through(points, spread, values), expected{2, 3, -1, 0.5};
    for (std::size_t m = 0; m < 4; ++m) EXPECT_NEAR(p[m], expected[m], 1e-12);
}

TEST(MultiscaleOrder, IsAPermutation) {
    std::mt19937 random = test::random_of_this_test();
    for (const std::size_t count : {1, 2, 9, 500}) {
        PointArrays points = random_points(count, random);
        if (count > 4)  // some closer than any level resolves
            for (const std::size_t i : {1, 2, 3}) {
                points.x[i] = points.x[0];
                points.y[i] = points.y[0];
                points.z[i] = points.z[0] + 1e-9 * static_cast<double>(i);
            }
        std::vector<std::int32_t> order = multiscale_order(points).order;
        std::sort(order.begin(), order.end());
        ASSERT_EQ(order.size(), count);
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(order[i], static_cast<std::int32_t>(i));
    }
}

TEST(MultiscaleOrder, EveryLevelRepresentsEachOccupiedCellOnce) {
    std::mt19937 random = test::random_of_this_test();
    PointArrays points = random_points(700, random);
    points.x[0] = points.y[0] = points.z[0] = -1;  // the box is [-1, 1]^3
    points.x[1] = points.y[1] = points.z[1] = 1;
    const MultiscaleOrder levels = multiscale_order(points);
    ASSERT_EQ(levels.level_begin.size(), levels.spacing.size() + 1);
    for (std::size_t level = 0; level < levels.spacing.size(); ++level) {
        const double width = levels.spacing[level];
        EXPECT_NEAR(width, std::pow(2, -static_cast<double>(level)), 1e-6);
        const auto cell = [&](std::size_t at) {
            const auto i = static_cast<std::size_t>(levels.order[at]);
            return std::array{std::floor((points.x[i] + 1) / width), std::floor((points.y[i] + 1) / width),
                              std::floor((points.z[i] + 1) / width)};
        };
        const auto begin = static_cast<std::size_t>(levels.level_begin[level]);
        const auto end = static_cast<std::size_t>(levels.level_begin[level + 1]);
        std::set<std::array<double, 3>> occupied, represented;
        for (std::size_t at = 0; at < 700; ++at) occupied.insert(cell(at));
        for (std::size_t at = 0; at < begin; ++at) represented.insert(cell(at));
        for (std::size_t at = begin; at < end; ++at) EXPECT_TRUE(represented.insert(cell(at)).second) << level;
        EXPECT_EQ(represented, occupied) << level;
    }
}

TEST(Preconditioner, IsTheExactInverseOfASmallSystem) {
    std::mt19937 random = test::random_of_this_test();
    for (const Kernel kernel : {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic})
        for (const double diagonal : {0.0, 1e-2}) {
            const PointArrays points = random_points(300, random);
            const std::vector<double> w = admissible_weights(points, random);
            std::vector<double> found(w.size());
            const auto pattern = std::make_shared<PreconditionerPattern>(points);
            Preconditioner(kernel, pattern, std::vector(points.size(), diagonal))
                .apply(matrix_times(kernel, points, diagonal, w), found);
            for (std::size_t i = 0; i < w.size(); ++i) ASSERT_NEAR(found[i], w[i], 1e-5) << name(kernel) << " " << diagonal;
        }
}

TEST(Preconditioner, IsSymmetricDefiniteAndTheSameForAnyNumberOfThreads) {
    std::mt19937 random = test::random_of_this_test();
    std::normal_distribution<double> normal;
    const PointArrays points = random_points(1500, random);
    const auto made_with = [&](int threads) {
        return Preconditioner(
            Kernel::triharmonic,
            std::make_shared<PreconditionerPattern>(points, PreconditionerOptions{}, Work{.threads = threads}),
            std::vector(points.size(), 0.0), {.threads = threads});
    };
    const Preconditioner one = made_with(1);
    std::vector<double> a(points.size()), b(points.size()), ma(a.size()), mb(a.size()), again(a.size());
    for (double& v : a) v = normal(random);
    for (double& v : b) v = normal(random);
    one.apply(a, ma);
    one.apply(b, mb);
    double a_mb = 0, b_ma = 0, a_ma = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        a_mb += a[i] * mb[i];
        b_ma += b[i] * ma[i];
        a_ma += a[i] * ma[i];
    }
    EXPECT_GT(a_ma, 0);
    EXPECT_NEAR(a_mb, b_ma, 1e-9 * a_ma);
    for (const int threads : {2, 3, 8}) {
        made_with(threads).apply(a, again);
        EXPECT_EQ(again, ma) << threads;
    }
    EXPECT_GT(one.megabytes(), 0);
}

TEST(Preconditioner, OnePatternServesAllDiagonalsAndKernels) {
    std::mt19937 random = test::random_of_this_test();
    const PointArrays points = random_points(900, random);
    const auto pattern = std::make_shared<PreconditionerPattern>(points);
    std::vector<double> r(points.size(), 1.0), shared(r.size()), own(r.size());
    for (const Kernel kernel : {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic})
        for (const double diagonal : {0.0, 1e-3, 1.0}) {
            Preconditioner(kernel, pattern, std::vector(points.size(), diagonal)).apply(r, shared);
            Preconditioner(kernel, std::make_shared<PreconditionerPattern>(points), std::vector(points.size(), diagonal))
                .apply(r, own);
            EXPECT_EQ(shared, own) << name(kernel) << " " << diagonal;
        }
}

TEST(Preconditioner, WithOtherEntriesOfTheDiagonalIsThatOfTheOtherMatrix) {
    std::mt19937 random = test::random_of_this_test();
    const PointArrays points = random_points(1500, random);
    const auto pattern = std::make_shared<const PreconditionerPattern>(points);
    const std::vector<double> before(points.size(), 1e-3);
    const Preconditioner earlier(Kernel::screened, pattern, before);
    for (const std::size_t changed : {0, 3, 700}) {
        std::vector<double> now = before;
        for (std::size_t i = 0; i < changed; ++i) now[(i * 977) % now.size()] = kLeftOut;
        std::vector<double> r(points.size(), 1.0), expected(r.size()), z(r.size());
        Preconditioner(Kernel::screened, pattern, now).apply(r, expected);
        Preconditioner(earlier, Kernel::screened, pattern, {before, now}).apply(r, z);
        EXPECT_EQ(z, expected) << changed;
    }
}

TEST(Preconditioner, TakesFurtherPointsIntoTheInverseOfASmallSystem) {
    std::mt19937 random = test::random_of_this_test();
    const PointArrays points = random_points(110, random);
    const std::vector<double> w = admissible_weights(points, random);
    PointArrays first = points;
    for (auto* axis : {&first.x, &first.y, &first.z}) axis->resize(100);
    const auto pattern =
        std::make_shared<const PreconditionerPattern>(first, PreconditionerOptions{.neighbours = 110, .dense_top = 20});
    const std::vector<double> before(100, 1e-2), now(110, 1e-2);
    const Preconditioner earlier(Kernel::triharmonic, pattern, before);
    const auto wider = std::make_shared<const PreconditionerPattern>(*pattern, points);
    std::vector<double> found(w.size());
    Preconditioner(earlier, Kernel::triharmonic, wider, {before, now})
        .apply(matrix_times(Kernel::triharmonic, points, 1e-2, w), found);
    for (std::size_t i = 0; i < w.size(); ++i) EXPECT_NEAR(found[i], w[i], 0.02) << i;
}

TEST(PreconditionerPattern, StopsWhenAsked) {
    std::mt19937 random = test::random_of_this_test();
    StopSource stop;
    stop.request_stop();
    EXPECT_THROW(PreconditionerPattern(random_points(2000, random), {}, {.threads = 2, .stop = stop.token()}), Error);
}

TEST(EarlierNeighbours, AreTheNearestToAnyMember) {
    std::mt19937 random = test::random_of_this_test();
    PointArrays points = random_points(1200, random);
    for (std::size_t i = 301; i < 330; ++i)
        for (auto* axis : {&points.x, &points.y, &points.z}) (*axis)[i] = (*axis)[300] + 0.1 * (*axis)[i];
    const EarlierNeighbours neighbours(points, {.threads = 2});
    // The last group is as wide as all: its box has far more points in it than are wanted.
    for (const auto& [begin, end, count] :
         {std::array{0, 4, 10}, {5, 9, 10}, {300, 330, 40}, {700, 701, 25}, {1100, 1120, 2000}, {1100, 1132, 40}}) {
        std::vector<std::pair<double, int>> all;
        for (int p = 0; p < begin; ++p) {
            double nearest = std::numeric_limits<double>::infinity();
            for (int m = begin; m < end; ++m)
                nearest =
                    std::min(nearest, distance(points[static_cast<std::size_t>(p)], points[static_cast<std::size_t>(m)]));
            all.emplace_back(nearest, p);
        }
        std::sort(all.begin(), all.end());
        all.resize(std::min<std::size_t>(all.size(), static_cast<std::size_t>(count)));
        std::vector<std::int32_t> expected;
        for (const auto& [nearest, p] : all) expected.push_back(p);
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(neighbours.of(begin, end, count), expected) << begin << " " << end;
    }
}

}  // namespace
}  // namespace kontur
