// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/kernel_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kontur/base/instruction_sets.h"
#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr std::size_t kLanes = 32;  // rows of the matrix that are held in vector registers
// Rows are dealt out to this many groups, each with an output of its own, whatever the number of threads.
constexpr std::size_t kMostGroups = 16;

struct Rows {
    alignas(64) std::array<double, kLanes> x{}, y{}, z{}, w{}, sum{};
};

struct Columns {
    const double *x, *y, *z, *w;
    double* sum;
    std::size_t begin, end;
};

/// Both triangles of the block rows x columns: phi is computed once and serves row and column sums.
template <class Phi>
[[gnu::always_inline]] inline void multiply_block(Rows& __restrict rows, const Columns& c, Phi phi) {
    for (std::size_t j = c.begin; j < c.end; ++j) {
        const double cx = c.x[j], cy = c.y[j], cz = c.z[j], cw = c.w[j];
        alignas(64) double column[kLanes];
        for (std::size_t l = 0; l < kLanes; ++l) {
            const double dx = rows.x[l] - cx, dy = rows.y[l] - cy, dz = rows.z[l] - cz;
            const double value = phi(dx * dx + dy * dy + dz * dz);
            rows.sum[l] += cw * value;
            column[l] = rows.w[l] * value;
        }
        for (std::size_t half = kLanes / 2; half > 0; half /= 2)
            for (std::size_t l = 0; l < half; ++l) column[l] += column[l + half];
        c.sum[j] += column[0];
    }
}

KONTUR_EVERY_INSTRUCTION_SET void multiply_triharmonic(Rows& rows, const Columns& columns) {
    multiply_block(rows, columns, [](double r2) { return r2 * std::sqrt(r2); });
}

KONTUR_EVERY_INSTRUCTION_SET void multiply_biharmonic(Rows& rows, const Columns& columns) {
    multiply_block(rows, columns, [](double r2) { return std::sqrt(r2); });
}

}  // namespace

DirectKernelMatrix::DirectKernelMatrix(Kernel kernel, PointArrays points, int threads)
    : kernel_(kernel), points_(std::move(points)), threads_(threads) {}

double DirectKernelMatrix::megabytes() const {
    return static_cast<double>(points_.size() * (3 + kMostGroups) * sizeof(double)) / (1 << 20);
}

void DirectKernelMatrix::multiply(std::span<const double> weights, std::span<double> out) const {
    const std::size_t n = points_.size();
    const auto multiply_rows = kernel_ == Kernel::triharmonic ? multiply_triharmonic : multiply_biharmonic;
    const std::size_t tiles = (n + kLanes - 1) / kLanes;
    const std::size_t groups = std::min(kMostGroups, tiles);
    std::vector<double> sums(groups * n);

    const auto multiply_tile = [&](std::size_t tile, double* sum) {
        const std::size_t begin = tile * kLanes, end = std::min(begin + kLanes, n);
        Rows rows;
        for (std::size_t l = 0; l < kLanes; ++l) {
            const std::size_t i = std::min(begin + l, n - 1);
            rows.x[l] = points_.x[i];
            rows.y[l] = points_.y[i];
            rows.z[l] = points_.z[i];
            rows.w[l] = begin + l < n ? weights[i] : 0.0;
        }
        Columns columns{points_.x.data(), points_.y.data(), points_.z.data(), weights.data(), sum, end, n};
        multiply_rows(rows, columns);
        // Within the tile every ordered pair is visited, so only the column sums are kept.
        const std::array<double, kLanes> beyond = rows.sum;
        columns.begin = begin;
        columns.end = end;
        multiply_rows(rows, columns);
        for (std::size_t i = begin; i < end; ++i) sum[i] += beyond[i - begin];
    };
    // Early tiles have more columns than late ones: tile g goes to the same group as its mirror image.
    parallel_for(static_cast<std::int64_t>(groups), 1, threads_, [&](std::int64_t first, std::int64_t last) {
        for (auto g = static_cast<std::size_t>(first); g < static_cast<std::size_t>(last); ++g)
            for (std::size_t tile = 0; tile < tiles; ++tile) {
                const std::size_t turn = tile % (2 * groups);
                if (std::min(turn, 2 * groups - 1 - turn) == g) multiply_tile(tile, sums.data() + g * n);
            }
    });
    parallel_for(static_cast<std::int64_t>(n), 4096, threads_, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            double total = 0;
            for (std::size_t g = 0; g < groups; ++g) total += sums[g * n + i];
            out[i] = total;
        }
    });
}

std::unique_ptr<KernelMatrix> make_kernel_matrix(Kernel kernel, const PointArrays& points, int threads) {
    return std::make_unique<DirectKernelMatrix>(kernel, points, threads);
}

}  // namespace kontur
