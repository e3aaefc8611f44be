// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/kernel_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random.h"

namespace kontur {
namespace {

struct Problem {
    PointArrays points;
    std::vector<double> weights;
};

Problem random_problem(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::normal_distribution<double> weight;
    Problem problem;
    for (std::size_t i = 0; i < count; ++i) {
        problem.points.x.push_back(coordinate(random));
        problem.points.y.push_back(coordinate(random));
        problem.points.z.push_back(coordinate(random));
        problem.weights.push_back(weight(random));
    }
    return problem;
}

TEST(DirectKernelMatrix, MultipliesAsTheFullSumDoes) {
    std::mt19937 random = test::random_of_this_test();
    for (const Kernel kernel : {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic})
        for (const std::size_t count : {1, 2, 31, 32, 33, 64, 65, 1000, 1500}) {
            const Problem p = random_problem(count, random);
            std::vector<double> expected(count), product(count, -1.0);
            sum_kernel({kernel, p.points, p.weights}, p.points, expected, {.threads = 1});
            DirectKernelMatrix(kernel, p.points, {.threads = 2}).multiply(p.weights, product);
            for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(product[i], expected[i], 1e-10) << count << " points, " << i;
        }
}

TEST(DirectKernelMatrix, MultipliesWeightsThatAreMostlyZeroAsTheFullSumDoes) {
    std::mt19937 random = test::random_of_this_test();
    for (const std::size_t with_weight : {0, 1, 100, 499, 500, 501}) {
        Problem p = random_problem(1000, random);
        std::fill(p.weights.begin(), p.weights.end() - static_cast<std::ptrdiff_t>(with_weight), 0.0);
        std::shuffle(p.weights.begin(), p.weights.end(), random);
        std::vector<double> expected(1000), product(1000, -1.0);
        sum_kernel({Kernel::screened, p.points, p.weights}, p.points, expected, {.threads = 1});
        DirectKernelMatrix(Kernel::screened, p.points, {.threads = 2}).multiply(p.weights, product);
        for (std::size_t i = 0; i < 1000; ++i) EXPECT_NEAR(product[i], expected[i], 1e-10) << with_weight << ", " << i;
    }
}

TEST(DirectKernelMatrix, IsTheSameForAnyNumberOfThreads) {
    std::mt19937 random = test::random_of_this_test();
    const Problem p = random_problem(1234, random);
    std::vector<double> one(1234), other(1234);
    DirectKernelMatrix(Kernel::triharmonic, p.points, {.threads = 1}).multiply(p.weights, one);
    for (const int threads : {2, 3, 8}) {
        DirectKernelMatrix(Kernel::triharmonic, p.points, {.threads = threads}).multiply(p.weights, other);
        EXPECT_EQ(one, other) << threads;
    }
}

TEST(BorderedKernelMatrix, MultipliesAsTheFullSumDoes) {
    std::mt19937 random = test::random_of_this_test();
    const std::size_t count = 700;
    const Problem p = random_problem(count, random);
    std::vector<double> expected(count), product(count, -1.0);
    sum_kernel({Kernel::screened, p.points, p.weights}, p.points, expected, {.threads = 1});
    for (const std::size_t inner : {1, 650, 699, 700}) {
        PointArrays first = p.points;
        for (auto* axis : {&first.x, &first.y, &first.z}) axis->resize(inner);
        const auto matrix = std::make_shared<const DirectKernelMatrix>(Kernel::screened, first);
        BorderedKernelMatrix(Kernel::screened, matrix, p.points, {.threads = 2}).multiply(p.weights, product);
        for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(product[i], expected[i], 1e-10) << inner << ", " << i;
    }
}

}  // namespace
}  // namespace kontur
