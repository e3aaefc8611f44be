// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/fast_function.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/function/evaluation_plan.h"
#include "support/expect_error.h"
#include "support/functions.h"
#include "support/random.h"

namespace kontur {
namespace {

constexpr std::int64_t kPoints = 60000;
const Vec3 kCenter{150, -80, 1200};

double bumpy_radius(const Vec3& d) { return 60 + 8 * std::sin(5 * d.x) * std::cos(4 * d.y) + 5 * d.z; }

/// The interpolant of a bumpy body with unsteady points, of eight thousand centres.
const ImplicitFunction& bumpy(Kernel kernel) {
    const auto make = [](Kernel k) {
        std::mt19937 random(7);
        std::normal_distribution<double> jitter(0, 0.1);
        ConstraintSet set;
        for (const Vec3& d : test::unit_sphere(5).points)
            for (const double offset : {0.0, 1.0}) {
                set.centers.push_back(kCenter + (bumpy_radius(d) + offset + jitter(random)) * d);
                set.values.push_back(-offset);
            }
        return solve(set, {.kernel = k, .smoothing = 1e-5}).function;
    };
    static const ImplicitFunction screened = make(Kernel::screened), cubic = make(Kernel::triharmonic),
                                  linear = make(Kernel::biharmonic);
    return kernel == Kernel::screened ? screened : kernel == Kernel::triharmonic ? cubic : linear;
}

std::vector<Vec3> points_about_surface(std::size_t count, std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 d = normalized({normal(random), normal(random), normal(random)});
        points.push_back(kCenter + (bumpy_radius(d) + normal(random)) * d);
    }
    return points;
}

std::vector<double> exact_values(const ImplicitFunction& function, const std::vector<Vec3>& points) {
    std::vector<double> values(points.size());
    function.values(points, values);
    return values;
}

class FastFunctionOfKernel : public testing::TestWithParam<Kernel> {};
INSTANTIATE_TEST_SUITE_P(, FastFunctionOfKernel, testing::Values(Kernel::screened, Kernel::triharmonic, Kernel::biharmonic),
                         [](const auto& test) { return std::string(name(test.param)); });

TEST_P(FastFunctionOfKernel, AgreesWithDirectSumsFromAFractionOfTheirTerms) {
    const ImplicitFunction& function = bumpy(GetParam());
    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> points = points_about_surface(kPoints, random);
    FastFunction fast(function, {.tolerance_mm = 0.05, .expected_points = kPoints});
    std::vector<double> values(points.size());
    fast.values(points, values);
    ASSERT_FALSE(fast.is_direct());
    EXPECT_LT(fast.kernel_values(), static_cast<std::int64_t>(points.size() * function.centers().size()) / 2);

    const std::vector<double> exact = exact_values(function, points);
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) largest = std::max(largest, std::abs(values[i] - exact[i]));
    EXPECT_LT(largest, 0.01);
    EXPECT_GT(fast.error_mm(), largest / 10) << "the check does not see the errors";
    EXPECT_LE(fast.error_mm(), largest);
}

TEST_P(FastFunctionOfKernel, GradientsAgreeWithDirectSums) {
    const ImplicitFunction& function = bumpy(GetParam());
    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> points = points_about_surface(kPoints, random);
    FastFunction fast(function, {.expected_points = kPoints});
    std::vector<Vec3> gradients(points.size()), exact(points.size());
    fast.gradients(points, gradients);
    ASSERT_FALSE(fast.is_direct());
    function.gradients(points, exact);
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_LT(distance(gradients[i], exact[i]), 0.01);
}

TEST(FastFunction, LevelsOfLatticesAgreeWithDirectSumsToo) {
    const ImplicitFunction& function = bumpy(Kernel::triharmonic);
    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> points = points_about_surface(300, random);
    const std::vector<double> exact = exact_values(function, points);
    // As if there were a hundred million points.
    FastFunction fast(function, {.tolerance_mm = 0.05, .expected_points = 100'000'000});
    ASSERT_GT(plan_evaluation(function, 1e8).spacings.size(), 1u);
    std::vector<double> values(points.size());
    fast.values(points, values);
    ASSERT_FALSE(fast.is_direct());
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(values[i], exact[i], 0.02);
}

TEST(FastFunction, SameBytesForAnyNumberOfThreadsAndAnyBatch) {
    const ImplicitFunction& function = bumpy(Kernel::triharmonic);
    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> points = points_about_surface(5000, random);
    const FastOptions options{.expected_points = kPoints};
    std::vector<double> all(points.size());
    std::vector<Vec3> gradients(points.size());
    FastFunction at_once(function, options);
    at_once.values(points, all, {.threads = 1});
    at_once.gradients(points, gradients, {.threads = 1});
    for (const int threads : {2, 5}) {
        FastFunction in_parts(function, options);
        std::vector<double> parts(points.size());
        std::vector<Vec3> gradient_parts(points.size());
        for (std::size_t begin = 0; begin < points.size(); begin += 1000) {
            in_parts.values(std::span(points).subspan(begin, 1000), std::span(parts).subspan(begin, 1000),
                            {.threads = threads});
            in_parts.gradients(std::span(points).subspan(begin, 1000), std::span(gradient_parts).subspan(begin, 1000),
                               {.threads = threads});
        }
        EXPECT_FALSE(in_parts.is_direct());
        EXPECT_EQ(parts, all);
        EXPECT_EQ(gradient_parts, gradients);
    }
}

TEST(FastFunction, TakesFinerLatticesOnceItMissesTheTolerance) {
    const ImplicitFunction& function = bumpy(Kernel::screened);
    constexpr std::int64_t kExpected = 10 * kPoints;
    const EvaluationPlan first = plan_evaluation(function, kExpected);
    const EvaluationPlan second = plan_evaluation(function, kExpected, first.spacings.back() / 2);
    ASSERT_FALSE(second.spacings.empty());
    EXPECT_LE(second.spacings.back(), 0.51 * first.spacings.back());

    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> points = points_about_surface(kPoints, random);
    std::vector<double> values(points.size());
    FastFunction coarse(function, {.tolerance_mm = 1, .expected_points = kExpected});
    coarse.values(points, values);
    const double tolerance_mm = coarse.error_mm() / 2;

    FastFunction fast(function, {.tolerance_mm = tolerance_mm, .expected_points = kExpected});
    fast.values(points, values);
    EXPECT_FALSE(fast.is_direct());
    EXPECT_LE(fast.error_mm(), tolerance_mm);
    EXPECT_GT(fast.kernel_values(), coarse.kernel_values()) << "what the first lattices cost is forgotten";
    const std::vector<double> exact = exact_values(function, points);
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_NEAR(values[i], exact[i], 3 * tolerance_mm);
}

TEST(FastFunction, AnswersByDirectSumsOnceItMissesTheTolerance) {
    const ImplicitFunction& function = bumpy(Kernel::triharmonic);
    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> points = points_about_surface(1000, random);
    FastFunction fast(function, {.tolerance_mm = 1e-7, .expected_points = kPoints});
    EXPECT_FALSE(fast.is_direct());
    std::vector<double> values(points.size());
    fast.values(points, values);
    EXPECT_TRUE(fast.is_direct());
    EXPECT_EQ(fast.error_mm(), 0);
    EXPECT_EQ(values, exact_values(function, points));

    FastFunction steep(function, {.gradient_tolerance = 1e-9, .expected_points = kPoints});
    std::vector<Vec3> gradients(points.size()), exact(points.size());
    steep.gradients(points, gradients);
    function.gradients(points, exact);
    EXPECT_TRUE(steep.is_direct());
    EXPECT_EQ(gradients, exact);
}

TEST(FastFunction, IsTheDirectSumForFewPointsFewCentresAndPointsBeyondReach) {
    const ImplicitFunction& function = bumpy(Kernel::triharmonic);
    EXPECT_TRUE(FastFunction(function, {.expected_points = 100}).is_direct());
    EXPECT_TRUE(FastFunction(test::ball_function({}, 5), {.expected_points = 1'000'000}).is_direct());
    EXPECT_TRUE(FastFunction(ImplicitFunction(), {.expected_points = 1'000'000}).is_direct());

    FastFunction fast(function, {.expected_points = kPoints});
    const std::vector<Vec3> far{kCenter, {1e9, 0, 0}};
    std::vector<double> values(2);
    fast.values(far, values);
    EXPECT_EQ(values, exact_values(function, far));
    fast.values({}, {});
}

TEST(FastFunction, StopsWhenAskedTo) {
    StopSource source;
    source.request_stop();
    const std::vector<Vec3> points(10, kCenter);
    std::vector<double> values(10);
    std::vector<Vec3> gradients(10);
    for (const std::int64_t expected : {std::int64_t{0}, kPoints}) {
        const FastOptions options{.expected_points = expected};
        const Work stopped{.stop = source.token()};
        EXPECT_KONTUR_ERROR(FastFunction(bumpy(Kernel::triharmonic), options).values(points, values, stopped),
                            ErrorKind::cancelled, "");
        EXPECT_KONTUR_ERROR(FastFunction(bumpy(Kernel::triharmonic), options).gradients(points, gradients, stopped),
                            ErrorKind::cancelled, "");
    }
}

TEST(EvaluationPlan, CostsNoMoreThanDirectSumsAndGrowsSlowerThanThePoints) {
    const ImplicitFunction& function = bumpy(Kernel::triharmonic);
    const auto centers = static_cast<double>(function.centers().size());
    double before = 0;
    for (const double points : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
        const EvaluationPlan plan = plan_evaluation(function, points);
        EXPECT_LE(plan.cost, points * centers);
        EXPECT_GE(plan.cost, before);
        EXPECT_TRUE(std::is_sorted(plan.spacings.begin(), plan.spacings.end()));
        before = plan.cost;
    }
    EXPECT_TRUE(plan_evaluation(function, 1e3).spacings.empty());
    EXPECT_LT(before, 1e7 * centers / 4);
}

}  // namespace
}  // namespace kontur
