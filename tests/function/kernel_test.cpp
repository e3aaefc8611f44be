// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/kernel.h"
#include "kontur/base/stop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kontur/function/implicit_function.h"
#include "kontur/function/kernel_sums.h"
#include "support/expect_error.h"
#include "support/random.h"

namespace kontur {
namespace {

constexpr Kernel kKernels[] = {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic};

std::vector<Vec3> random_points(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    return points;
}

std::vector<double> random_weights(std::size_t count, std::mt19937& random) {
    std::normal_distribution<double> weight;
    std::vector<double> weights;
    for (std::size_t i = 0; i < count; ++i) weights.push_back(weight(random));
    return weights;
}

/// kernel_value by its definition; of the screened kernel what is left when its even powers are gone.
double naive_kernel(Kernel kernel, double r) {
    constexpr double l = kScreeningLength;
    if (kernel == Kernel::biharmonic) return r;
    if (kernel == Kernel::triharmonic) return std::pow(r, 3);
    return screened_kernel(r) - 3 * std::pow(l, 3) + 1.5 * l * r * r;
}

double naive_slope(Kernel kernel, double r) {
    constexpr double l = kScreeningLength;
    if (kernel == Kernel::biharmonic) return 1;
    if (kernel == Kernel::triharmonic) return 3 * r * r;
    return -3 * l * r * std::exp(-r / l) + 3 * l * r;
}

double naive_sum(Kernel kernel, const std::vector<Vec3>& centers, const std::vector<double>& weights, const Vec3& at) {
    double sum = 0;
    for (std::size_t j = 0; j < centers.size(); ++j) sum += weights[j] * naive_kernel(kernel, distance(at, centers[j]));
    return sum;
}

Vec3 naive_gradient(Kernel kernel, const std::vector<Vec3>& centers, const std::vector<double>& weights, const Vec3& at) {
    Vec3 sum;
    for (std::size_t j = 0; j < centers.size(); ++j) {
        const double r = distance(at, centers[j]);
        if (r > 0) sum += weights[j] * naive_slope(kernel, r) / r * (at - centers[j]);
    }
    return sum;
}

/// A function on a frame far from the origin.
ImplicitFunction random_function(Kernel kernel, std::mt19937& random) {
    const PointArrays centers(random_points(77, random));
    const bool screened = kernel == Kernel::screened;
    return {kernel,
            {{100, -200, 50}, 30},
            centers,
            random_weights(77, random),
            screened ? std::array<double, 4>{-30} : std::array<double, 4>{0.3, -1, 2, 0.5}};
}

TEST(SumKernel, IsTheObviousDoubleLoop) {
    std::mt19937 random = test::random_of_this_test();
    for (const Kernel kernel : kKernels)
        for (const std::size_t count : {0, 1, 31, 32, 33, 127, 128, 129, 1000}) {
            const std::vector<Vec3> centers = random_points(61, random);
            std::vector<Vec3> targets = random_points(count, random);
            if (count > 1) targets[1] = centers[5];  // at a centre
            const std::vector<double> weights = random_weights(centers.size(), random);
            std::vector<double> sums(count);
            std::vector<Vec3> gradients(count);
            sum_kernel({kernel, PointArrays(centers), weights}, PointArrays(targets), sums, {.threads = 2});
            sum_kernel_gradient({kernel, PointArrays(centers), weights}, PointArrays(targets), gradients, {.threads = 2});
            for (std::size_t t = 0; t < count; ++t) {
                ASSERT_NEAR(sums[t], naive_sum(kernel, centers, weights, targets[t]), 1e-11);
                ASSERT_LT(distance(gradients[t], naive_gradient(kernel, centers, weights, targets[t])), 1e-10);
            }
        }
}

TEST(SumKernel, NoCentersGiveZero) {
    std::vector<double> sums(3, 1.0);
    sum_kernel({Kernel::triharmonic, PointArrays(), {}}, PointArrays(std::vector<Vec3>(3)), sums, {.threads = 1});
    EXPECT_EQ(sums, std::vector<double>(3, 0.0));
}

TEST(SumKernel, SameBytesForAnyNumberOfThreads) {
    std::mt19937 random = test::random_of_this_test();
    const PointArrays centers(random_points(200, random)), targets(random_points(1001, random));
    const std::vector<double> weights = random_weights(200, random);
    for (const Kernel kernel : kKernels) {
        std::vector<double> one(targets.size()), many(targets.size());
        std::vector<Vec3> one_gradient(targets.size()), many_gradients(targets.size());
        sum_kernel({kernel, centers, weights}, targets, one, {.threads = 1});
        sum_kernel_gradient({kernel, centers, weights}, targets, one_gradient, {.threads = 1});
        for (const int threads : {2, 3, 8}) {
            sum_kernel({kernel, centers, weights}, targets, many, {.threads = threads});
            sum_kernel_gradient({kernel, centers, weights}, targets, many_gradients, {.threads = threads});
            EXPECT_EQ(many, one) << threads;
            EXPECT_EQ(many_gradients, one_gradient) << threads;
        }
    }
}

TEST(SumKernel, TwoWeightsGiveTheSumsOfEitherToTheLastBit) {
    std::mt19937 random = test::random_of_this_test();
    const PointArrays centers(random_points(83, random)), targets(random_points(333, random));
    const std::vector<double> first = random_weights(83, random), second = random_weights(83, random);
    std::vector<double> expected(333), second_expected(333), sums(333), second_sums(333);
    sum_far_kernel(centers, first, targets, expected, {.threads = 1});
    sum_far_kernel(centers, second, targets, second_expected, {.threads = 1});
    for (const int threads : {1, 2, 3}) {
        sum_far_kernel_twice(centers, {first, second}, targets, {sums, second_sums}, {.threads = threads});
        EXPECT_EQ(sums, expected) << threads;
        EXPECT_EQ(second_sums, second_expected) << threads;
    }
}

TEST(ImplicitFunction, GradientIsTheFiniteDifferenceOfTheValue) {
    std::mt19937 random = test::random_of_this_test();
    for (const Kernel kernel : kKernels) {
        const ImplicitFunction function = random_function(kernel, random);
        for (const Vec3& unit : random_points(20, random)) {
            const Vec3 p = function.frame().center + function.frame().scale * unit;
            const double h = 1e-4;
            const Vec3 difference{function.value(p + Vec3{h, 0, 0}) - function.value(p - Vec3{h, 0, 0}),
                                  function.value(p + Vec3{0, h, 0}) - function.value(p - Vec3{0, h, 0}),
                                  function.value(p + Vec3{0, 0, h}) - function.value(p - Vec3{0, 0, h})};
            EXPECT_LT(distance(function.gradient(p), difference / (2 * h)), 1e-6);
        }
    }
}

TEST(ImplicitFunction, ValueDoesNotDependOnTheBatch) {
    std::mt19937 random = test::random_of_this_test();
    for (const Kernel kernel : kKernels) {
        const ImplicitFunction function = random_function(kernel, random);
        std::vector<Vec3> points;  // some of them so far away that they have sums of their own
        for (const Vec3& unit : random_points(140, random))
            points.push_back(function.frame().center + (points.size() % 3 == 0 ? 3000 : 30) * unit);
        for (const std::size_t begin : {0, 1, 30})
            for (const std::size_t count : {1, 2, 31, 32, 33, 110}) {
                const std::span<const Vec3> batch{points.data() + begin, count};
                std::vector<double> values(count);
                std::vector<Vec3> gradients(count);
                function.values(batch, values, {.threads = 2});
                function.gradients(batch, gradients, {.threads = 2});
                for (std::size_t i = 0; i < count; ++i) {
                    ASSERT_EQ(values[i], function.value(batch[i]));
                    ASSERT_EQ(gradients[i], function.gradient(batch[i]));
                }
            }
    }
}

TEST(ImplicitFunction, AStopEndsItsSums) {
    std::mt19937 random(3);
    const std::vector<Vec3> points = random_points(5000, random);
    const ImplicitFunction f(Kernel::screened, {}, PointArrays(points), std::vector<double>(points.size(), 1.0), {});
    std::vector<double> values(points.size());
    std::vector<Vec3> gradients(points.size());
    StopSource source;
    source.request_stop();
    const Work work{.stop = source.token()};
    EXPECT_KONTUR_ERROR(f.values(points, values, work), ErrorKind::cancelled, "");
    EXPECT_KONTUR_ERROR(f.values_and_gradients(points, values, gradients, work), ErrorKind::cancelled, "");
}

/// Near the centres the sums of phi and the even powers, farther out sums of k itself.
TEST(ImplicitFunction, ScreenedIsTheSumOfItsKernelAndTheMeanEverywhere) {
    std::mt19937 random = test::random_of_this_test();
    const ImplicitFunction f = random_function(Kernel::screened, random);
    for (const double reach : {0.5, 2.0, 2.5, 3.0, 10.0, 1e3})
        for (const Vec3& unit : random_points(20, random)) {
            const Vec3 u = reach * normalized(unit);
            double farthest = 1.25;
            for (std::size_t j = 0; j < f.centers().size(); ++j) farthest = std::max(farthest, norm(f.centers()[j]));
            const double beyond = std::max(reach - farthest, 0.0), scale = f.frame().scale;
            double expected = f.polynomial()[0] - 16 * scale * std::pow(beyond, 3);
            Vec3 slope = -48 * scale * beyond * beyond / reach * u;
            for (std::size_t j = 0; j < f.centers().size(); ++j) {
                const double r = distance(u, f.centers()[j]);
                expected += f.weights()[j] * screened_kernel(r);
                slope += f.weights()[j] * screened_kernel_slope(r) * (u - f.centers()[j]);
            }
            const Vec3 at = f.frame().center + f.frame().scale * u;
            EXPECT_NEAR(f.value(at), expected, 1e-9 + 1e-12 * std::abs(expected)) << reach;
            EXPECT_LT(distance(f.gradient(at), slope / scale), 1e-10 + 1e-12 * norm(slope)) << reach;
        }
}

TEST(ImplicitFunction, ScreenedHasNoPolynomialButItsMean) {
    EXPECT_KONTUR_ERROR(ImplicitFunction(Kernel::screened, {}, PointArrays(std::vector<Vec3>{{}}), {1}, {-1, 0, 0.5, 0}),
                        ErrorKind::invalid_input, "goes back to a mean");
}

TEST(ScreenedKernel, IsRCubedNearItsCentreAndEndsFarFromIt) {
    for (const double r : {1e-3, 1e-2, 0.1})
        EXPECT_NEAR(kernel_value(Kernel::screened, r) / (r * r * r), 1 - 0.375 * r / kScreeningLength, 2 * r * r / 100);
    EXPECT_LT(screened_kernel(25 * kScreeningLength), 1e-6);
    EXPECT_EQ(screened_kernel(0), 3 * std::pow(kScreeningLength, 3));
}

TEST(ScreenedKernel, TakesNoExponentialToBeSummed) {
    for (double r = 0; r < 300; r += 0.37) {
        const double expected = screened_kernel(r);
        EXPECT_NEAR(screened_kernel_far(r), expected, 1e-13 * expected + 1e-12) << r;
        if (r > kScreenedReach) continue;
        const double even_powers = 3 * std::pow(kScreeningLength, 3) - 1.5 * kScreeningLength * r * r;
        EXPECT_NEAR(even_powers + kernel_value(Kernel::screened, r), expected, 1e-12) << r;
    }
}

TEST(ImplicitFunction, HasNoValueNowhere) {
    const PointArrays centers(std::vector<Vec3>{{0, 0, 0}, {0.5, 0, 0}});
    for (const Kernel kernel : {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic}) {
        const ImplicitFunction f(kernel, {}, centers, {1, -1}, {5, 0, 0, 0});
        for (const double nowhere : {std::nan(""), std::numeric_limits<double>::infinity()}) {
            EXPECT_TRUE(std::isnan(f.value({0, nowhere, 0}))) << f.value({0, nowhere, 0});
            EXPECT_FALSE(is_finite(f.gradient({0, nowhere, 0})));
        }
        const std::vector<Vec3> points{{0, std::nan(""), 0}, {0.2, 0, 0}};
        std::vector<double> values(2);
        f.values(points, values);
        EXPECT_TRUE(std::isnan(values[0]));
        EXPECT_EQ(values[1], f.value(points[1]));
    }
}

TEST(ImplicitFunction, DefaultIsZeroEverywhere) {
    EXPECT_EQ(ImplicitFunction().value({1, 2, 3}), 0);
    EXPECT_EQ(ImplicitFunction().gradient({1, 2, 3}), Vec3());
}

TEST(UnitFrame, PutsThePointsIntoTheUnitBall) {
    const std::vector<Vec3> points{{1000, 0, 0}, {1040, 10, 5}, {1020, -10, 2}};
    const UnitFrame frame = unit_frame(points);
    for (const Vec3& p : points) EXPECT_LE(norm(frame.to_unit(p)), 1 + 1e-12);
    EXPECT_NEAR(norm(frame.to_unit(points[0])), 1, 1e-12);
    EXPECT_NEAR(norm(frame.to_unit(points[1])), 1, 1e-12);
    EXPECT_NEAR(frame.scale * distance(frame.to_unit(points[1]), frame.to_unit(points[0])), distance(points[0], points[1]),
                1e-12);
    EXPECT_EQ(unit_frame(std::vector<Vec3>{{7, 8, 9}}).scale, 1);
}

}  // namespace
}  // namespace kontur
