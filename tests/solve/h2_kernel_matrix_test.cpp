// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/h2_kernel_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "kontur/base/error.h"
#include "kontur/solve/solve.h"
#include "support/random.h"

namespace kontur {
namespace {

using Points = std::vector<Vec3>;

Points cloud(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    Points points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    return points;
}

/// Circles of latitude on a ball with a second point outside each, as contours and their normal constraints lie.
Points contours(std::size_t count) {
    const std::size_t circles =
        std::max<std::size_t>(4, static_cast<std::size_t>(0.4 * std::sqrt(static_cast<double>(count))));
    const std::size_t per_circle = count / 2 / circles + 1;
    Points points;
    for (std::size_t c = 0; c < circles && points.size() + 1 < count; ++c)
        for (std::size_t p = 0; p < per_circle && points.size() + 1 < count; ++p) {
            const double polar = std::numbers::pi * (static_cast<double>(c) + 0.7) / (static_cast<double>(circles) + 0.4);
            const double azimuth = 2 * std::numbers::pi * static_cast<double>(p) / static_cast<double>(per_circle);
            const Vec3 on{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
            points.push_back(on);
            points.push_back({1.01 * on.x, 1.01 * on.y, on.z});
        }
    return points;
}

std::vector<double> random_weights(std::size_t count, std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::vector<double> w(count);
    for (double& v : w) v = normal(random);
    return w;
}

/// The product by plain loops.
std::vector<double> exact_product(Kernel kernel, const Points& points, const std::vector<double>& w) {
    std::vector<double> out(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < points.size(); ++j)
            out[i] += w[j] * kernel_value(kernel, distance(points[i], points[j]));
    return out;
}

std::vector<double> product(const KernelMatrix& matrix, const std::vector<double>& w) {
    std::vector<double> out(w.size());
    matrix.multiply(w, out);
    return out;
}

/// Largest error of the product with random weights, over the tolerance times the norm of the weights.
double relative_error(Kernel kernel, const Points& points, const H2Options& options, std::mt19937& random) {
    const std::vector<double> w = random_weights(points.size(), random);
    const std::vector<double> found = product(H2KernelMatrix(kernel, PointArrays(points), options, {.threads = 2}), w),
                              expected = exact_product(kernel, points, w);
    double squares = 0, largest = 0;
    for (const double v : w) squares += v * v;
    for (std::size_t i = 0; i < w.size(); ++i) largest = std::max(largest, std::abs(found[i] - expected[i]));
    return largest / (options.tolerance * std::sqrt(squares));
}

TEST(H2KernelMatrix, ErrorIsAboutTheToleranceTimesTheNormOfTheWeights) {
    std::mt19937 random = test::random_of_this_test();
    for (const Kernel kernel : {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic})
        for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
            EXPECT_LT(relative_error(kernel, contours(3000), {.tolerance = tolerance}, random), 10)
                << name(kernel) << tolerance;
            // In a cloud nearly all points of a cluster are needed, and the proxies hardly outnumber them.
            EXPECT_LT(relative_error(kernel, cloud(3000, random), {.tolerance = tolerance}, random), 100)
                << name(kernel) << tolerance;
        }
}

TEST(H2KernelMatrix, IsRightForAnyNumberOfPoints) {
    std::mt19937 random = test::random_of_this_test();
    for (const std::size_t count : {1, 4, 5, 63, 64, 65, 128, 129, 500, 1601})
        for (const std::int32_t leaf_size : {1, 7, 64})
            EXPECT_LT(relative_error(Kernel::triharmonic, cloud(count, random), {.tolerance = 1e-9, .leaf_size = leaf_size},
                                     random),
                      10)
                << count << " " << leaf_size;
}

TEST(H2KernelMatrix, DegenerateClustersDoNotSpoilIt) {
    std::mt19937 random = test::random_of_this_test();
    const auto flattened = [&](const Vec3& keep) {
        Points points = cloud(1500, random);
        for (Vec3& p : points) p = {keep.x * p.x, keep.y * p.y, keep.z * p.z};
        return points;
    };
    Points outlier = cloud(1500, random), doubled = cloud(700, random), lattice, together(600, Vec3{0.3, 0.2, 0.1});
    for (std::size_t i = 1; i < outlier.size(); ++i) outlier[i] *= 1e-3;
    for (std::size_t i = 0; i < 700; ++i) doubled.push_back(doubled[i] + Vec3{1e-12, 0, 0});
    for (int i = 0; i < 1331; ++i) lattice.push_back({0.1 * (i % 11), 0.1 * (i / 11 % 11), 0.1 * (i / 121)});
    together.insert(together.end(), 600, Vec3{-1, 0, 1});
    const std::vector<std::pair<const char*, Points>> all{{"line", flattened({1, 0, 0})},
                                                          {"plane", flattened({1, 0, 1})},
                                                          {"point", flattened({0, 0, 0})},
                                                          {"outlier", outlier},
                                                          {"pairs", doubled},
                                                          {"equal coordinates", lattice},
                                                          {"two places", together}};
    for (const auto& [what, points] : all)
        for (const Kernel kernel : {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic})
            EXPECT_LT(relative_error(kernel, points, {.tolerance = 1e-9}, random), 10) << what << " " << name(kernel);
}

TEST(H2KernelMatrix, IsSymmetric) {
    std::mt19937 random = test::random_of_this_test();
    const Points points = contours(2500);
    const H2KernelMatrix matrix(Kernel::triharmonic, PointArrays(points), {.tolerance = 1e-4}, {.threads = 2});
    const std::vector<double> a = random_weights(points.size(), random), b = random_weights(points.size(), random);
    const std::vector<double> ma = product(matrix, a), mb = product(matrix, b);
    double a_mb = 0, b_ma = 0, size = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        a_mb += a[i] * mb[i];
        b_ma += b[i] * ma[i];
        size += std::abs(a[i] * mb[i]);
    }
    EXPECT_NEAR(a_mb, b_ma, 1e-12 * size);
}

TEST(H2KernelMatrix, SameBytesForAnyNumberOfThreads) {
    std::mt19937 random = test::random_of_this_test();
    const Points points = contours(4000);
    const std::vector<double> w = random_weights(points.size(), random);
    const std::vector<double> one = product(H2KernelMatrix(Kernel::triharmonic, PointArrays(points), {}, {.threads = 1}), w);
    for (const int threads : {2, 3, 8})
        EXPECT_EQ(product(H2KernelMatrix(Kernel::triharmonic, PointArrays(points), {}, {.threads = threads}), w), one)
            << threads;
}

TEST(H2KernelMatrix, EvaluationsAndMemoryGrowLinearly) {
    const auto matrix = [](std::size_t count) {
        return H2KernelMatrix(Kernel::triharmonic, PointArrays(contours(count)), {.tolerance = 1e-6}, {.threads = 2});
    };
    const H2KernelMatrix small = matrix(5000), large = matrix(20000);
    EXPECT_LT(large.evaluations(), 5.5 * small.evaluations());
    EXPECT_LT(large.megabytes(), 5 * small.megabytes());
    EXPECT_LT(large.evaluations(), 0.1 * 20000.0 * 20000.0);
}

TEST(H2KernelMatrix, StopsWhenAsked) {
    const PointArrays points(contours(3000));
    StopSource stop;
    const H2KernelMatrix matrix(Kernel::triharmonic, points, {}, {.threads = 2, .stop = stop.token()});
    stop.request_stop();
    const std::vector<double> w(points.size(), 1.0);
    EXPECT_THROW(product(matrix, w), Error);
    EXPECT_THROW(H2KernelMatrix(Kernel::triharmonic, points, {}, {.threads = 2, .stop = stop.token()}), Error);
}

TEST(ClusterTree, ClustersAreRunsInTheirBoxes) {
    std::mt19937 random = test::random_of_this_test();
    const Points points = cloud(1000, random);
    const ClusterTree tree(PointArrays(points), 20, {.threads = 3});
    EXPECT_EQ(std::set<std::int32_t>(tree.order.begin(), tree.order.end()).size(), points.size());
    for (const Cluster& cluster : tree.clusters) {
        for (std::int32_t i = cluster.begin; i < cluster.end; ++i)
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_LE(std::abs(points[static_cast<std::size_t>(tree.order[static_cast<std::size_t>(i)])][axis] -
                                   cluster.center[axis]),
                          cluster.half[axis] + 1e-15);
        if (cluster.is_leaf()) {
            EXPECT_LE(cluster.size(), 20);
            continue;
        }
        const Cluster &lower = tree.clusters[static_cast<std::size_t>(cluster.first_child)], *upper = &lower + 1;
        EXPECT_EQ(lower.begin, cluster.begin);
        EXPECT_EQ(lower.end, upper->begin);
        EXPECT_EQ(upper->end, cluster.end);
    }
}

TEST(PartitionPairs, EveryPairOfPointsIsInOneBlock) {
    std::mt19937 random = test::random_of_this_test();
    const std::size_t n = 400;
    const ClusterTree tree(PointArrays(cloud(n, random)), 8, {.threads = 1});
    const PairPartition partition = partition_pairs(tree, 1.5);
    EXPECT_GT(partition.far.size(), 0u);
    std::vector<int> seen(n * n);
    for (const auto* pairs : {&partition.far, &partition.near})
        for (const ClusterPair& pair : *pairs) {
            const Cluster &a = tree.clusters[static_cast<std::size_t>(pair.a)],
                          &b = tree.clusters[static_cast<std::size_t>(pair.b)];
            if (pairs == &partition.far) {
                EXPECT_LE(std::max(a.diameter(), b.diameter()), 1.5 * box_distance(a, b));
            }
            for (std::int32_t i = a.begin; i < a.end; ++i)
                for (std::int32_t j = b.begin; j < b.end; ++j) {
                    ++seen[static_cast<std::size_t>(i) * n + static_cast<std::size_t>(j)];
                    if (pair.a != pair.b) ++seen[static_cast<std::size_t>(j) * n + static_cast<std::size_t>(i)];
                }
        }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
}

TEST(InterpolateColumns, OfALowRankMatrixTheSkeletonSpansAll) {
    std::mt19937 random = test::random_of_this_test();
    const std::int32_t rows = 45, lead = 48, columns = 30, rank = 7;
    const std::vector<double> left = random_weights(rows * rank, random), right = random_weights(rank * columns, random);
    std::vector<double> a(static_cast<std::size_t>(lead * columns));
    for (int j = 0; j < columns; ++j)
        for (int i = 0; i < rows; ++i)
            for (int k = 0; k < rank; ++k) a[j * lead + i] += left[i * rank + k] * right[k * columns + j];
    std::vector<double> used = a;
    const Interpolation found = interpolate_columns(used.data(), rows, lead, columns, 1e-10);
    ASSERT_EQ(found.rank, rank);
    for (int j = rank; j < columns; ++j)
        for (int i = 0; i < rows; ++i) {
            double interpolated = 0;
            for (int k = 0; k < rank; ++k)
                interpolated += a[found.columns[k] * lead + i] * found.transfer[(j - rank) * rank + k];
            EXPECT_NEAR(interpolated, a[found.columns[j] * lead + i], 1e-9);
        }
}

}  // namespace
}  // namespace kontur
