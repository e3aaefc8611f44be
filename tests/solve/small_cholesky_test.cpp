// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/small_cholesky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random.h"

namespace kontur {
namespace {

/// A random symmetric positive definite matrix, full, column major.
std::vector<double> random_definite(int n, std::mt19937& random) {
    std::normal_distribution<double> entry;
    std::vector<double> b(static_cast<std::size_t>(n * n)), a(b.size());
    for (double& v : b) v = entry(random);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            for (int k = 0; k < n; ++k) a[i + j * n] += b[i + k * n] * b[j + k * n];
            if (i == j) a[i + j * n] += n;
        }
    return a;
}

/// The matrix with its columns padded; above the diagonal nothing that counts.
std::vector<double> padded(const std::vector<double>& a, int n) {
    const int lead = padded_rows(n);
    std::vector<double> result(static_cast<std::size_t>(lead * n), 7.0);
    for (int j = 0; j < n; ++j)
        for (int i = j; i < n; ++i) result[i + j * lead] = a[i + j * n];
    return result;
}

TEST(SmallCholesky, FactorTimesItsTransposeIsTheMatrix) {
    std::mt19937 random = test::random_of_this_test();
    for (const int n : {1, 2, 7, 8, 9, 15, 16, 17, 31, 32, 33, 63, 100, 131}) {
        const int lead = padded_rows(n);
        const std::vector<double> a = random_definite(n, random);
        std::vector<double> l = padded(a, n);
        ASSERT_TRUE(small_cholesky(l.data(), n)) << n;
        for (int j = 0; j < n; ++j)
            for (int i = j; i < n; ++i) {
                double product = 0;
                for (int k = 0; k <= j; ++k) product += l[i + k * lead] * l[j + k * lead];
                ASSERT_NEAR(product, a[i + j * n], 1e-10 * n) << n;
            }
    }
}

TEST(SmallCholesky, SolvesAndInverts) {
    std::mt19937 random = test::random_of_this_test();
    for (const int n : {1, 3, 5, 8, 33, 70})
        for (const int m : {1, n / 2 + 1, n}) {
            const int lead = padded_rows(n);
            const std::vector<double> a = random_definite(n, random);
            std::vector<double> l = padded(a, n), x(static_cast<std::size_t>(n)), right(x.size());
            ASSERT_TRUE(small_cholesky(l.data(), n));
            for (int i = 0; i < n; ++i) x[i] = std::sin(i + 1.0);
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) right[i] += a[i + j * n] * x[j];
            small_cholesky_solve(l.data(), n, right.data());
            for (int i = 0; i < n; ++i) EXPECT_NEAR(right[i], x[i], 1e-10);

            std::vector<double> rows(static_cast<std::size_t>(m * n));
            last_rows_of_inverse(l.data(), n, m, rows.data());
            for (int r = 0; r < m; ++r)
                for (int c = 0; c < n; ++c) {
                    double product = 0;  // row r of the inverse times column c of the factor
                    for (int k = c; k < n; ++k) product += rows[r * n + k] * l[k + c * lead];
                    EXPECT_NEAR(product, c == n - m + r ? 1 : 0, 1e-10) << n << " " << m;
                }
        }
}

TEST(SmallCholesky, ForwardSolvesManySidesAtOnce) {
    std::mt19937 random = test::random_of_this_test();
    std::normal_distribution<double> entry;
    for (const int n : {1, 3, 4, 17, 70})
        for (const int first : {0, 4, 16}) {
            if (first >= n) continue;
            const int lead = padded_rows(n);
            std::vector<double> l = padded(random_definite(n, random), n), x(static_cast<std::size_t>(n * kForwardSides));
            ASSERT_TRUE(small_cholesky(l.data(), n));
            for (int at = first * kForwardSides; at < n * kForwardSides; ++at) x[at] = entry(random);
            const std::vector<double> right = x;
            small_cholesky_forward(l.data(), n, first, x.data());
            for (int i = 0; i < n; ++i)
                for (int side = 0; side < kForwardSides; ++side) {
                    double product = 0;
                    for (int k = 0; k <= i; ++k) product += l[i + k * lead] * x[k * kForwardSides + side];
                    EXPECT_NEAR(product, right[i * kForwardSides + side], 1e-10) << n << " " << first;
                }
        }
}

TEST(SmallCholesky, NoticesAMatrixThatIsNotDefinite) {
    std::mt19937 random = test::random_of_this_test();
    for (const int bad : {0, 5, 11, 19}) {
        std::vector<double> a = random_definite(20, random);
        a[bad + 20 * bad] = -1;
        EXPECT_FALSE(small_cholesky(padded(a, 20).data(), 20)) << bad;
    }
}

}  // namespace
}  // namespace kontur
