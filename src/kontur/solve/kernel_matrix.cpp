// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/kernel_matrix.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "kontur/base/parallel.h"
#include "kontur/solve/h2_kernel_matrix.h"
#include "kontur/solve/pair_sums.h"

namespace kontur {
namespace {

constexpr std::size_t kTile = 32;  // rows of the matrix that are held in vector registers
// Rows are dealt out to this many groups, each with an output of its own, whatever the number of threads.

// On one core a pair takes 0.35 ns; an H2 matrix 4 us (oblique planes) to 10 us (many slices) per point once and 0.6 us per
// product. With nine products both cost the same between 5,500 and 7,500 points.
constexpr std::size_t kMostDirect = 7000;

}  // namespace

DirectKernelMatrix::DirectKernelMatrix(Kernel kernel, const PointArrays& points, const Work& work)
    : kernel_(kernel), size_(points.size()), points_(points), work_(work) {
    for (auto* axis : {&points_.x, &points_.y, &points_.z}) axis->resize(size_ + kNodePadding);
}

double DirectKernelMatrix::megabytes() const {
    return static_cast<double>(size_ * (3 + kMostGroups) * sizeof(double)) / (1 << 20);
}

void DirectKernelMatrix::multiply(std::span<const double> weights, std::span<double> out) const {
    const auto zeros = static_cast<std::size_t>(std::ranges::count(weights, 0.0));
    if (size_ < 2 * zeros) multiply_few(weights, out);
    else multiply_all(weights, out);
}

/// Sums only from the points that have a weight, as the first guess of a fit that was found with a part of them.
void DirectKernelMatrix::multiply_few(std::span<const double> weights, std::span<double> out) const {
    std::vector<Vec3> all, few;
    std::vector<double> few_weights;
    for (std::size_t i = 0; i < size_; ++i) {
        all.push_back(points_[i]);
        if (weights[i] == 0) continue;
        few.push_back(all.back());
        few_weights.push_back(weights[i]);
    }
    sum_kernel({kernel_, PointArrays(few), few_weights}, PointArrays(all), out, work_);
}

void DirectKernelMatrix::multiply_all(std::span<const double> weights, std::span<double> out) const {
    const std::size_t tiles = (size_ + kTile - 1) / kTile, groups = std::min(kMostGroups, tiles);
    std::vector<double> padded(weights.begin(), weights.end()), sums(groups * size_);
    padded.resize(size_ + kNodePadding);
    const NodeView nodes{points_.x.data(), points_.y.data(), points_.z.data(), padded.data()};

    const auto multiply_tile = [&](std::size_t tile, double* sum) {
        const auto begin = static_cast<std::int32_t>(tile * kTile), all = static_cast<std::int32_t>(size_);
        const NodeRun rows{begin, std::min(begin + static_cast<std::int32_t>(kTile), all)}, beyond{rows.end, all};
        add_own_sums(kernel_, nodes, rows, sum);
        add_mutual_sums(kernel_, nodes, rows, {&beyond, 1}, sum);
    };
    // Early tiles have more columns than late ones: tile g goes to the same group as its mirror image.
    parallel_for(static_cast<std::int64_t>(groups), 1, work_, [&](std::int64_t first, std::int64_t last) {
        for (auto g = static_cast<std::size_t>(first); g < static_cast<std::size_t>(last); ++g)
            for (std::size_t tile = 0; tile < tiles; ++tile) {
                const std::size_t turn = tile % (2 * groups);
                if (std::min(turn, 2 * groups - 1 - turn) != g) continue;
                work_.check();
                multiply_tile(tile, sums.data() + g * size_);
            }
    });
    parallel_for(static_cast<std::int64_t>(size_), 4096, work_, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            double total = 0;
            for (std::size_t g = 0; g < groups; ++g) total += sums[g * size_ + i];
            out[i] = total;
        }
    });
}

BorderedKernelMatrix::BorderedKernelMatrix(Kernel kernel, std::shared_ptr<const KernelMatrix> inner,
                                           const PointArrays& points, const Work& work)
    : inner_(std::move(inner)), size_(points.size()), rows_((size_ - inner_->size()) * size_), work_(work.untold()) {
    const std::size_t first = inner_->size();
    parallel_for(static_cast<std::int64_t>(size_ - first), 1, work_, [&](std::int64_t begin, std::int64_t end) {
        for (auto a = static_cast<std::size_t>(begin); a < static_cast<std::size_t>(end); ++a)
            for (std::size_t j = 0; j < size_; ++j)
                rows_[a * size_ + j] = kernel_value(kernel, distance(points[first + a], points[j]));
    });
}

void BorderedKernelMatrix::multiply(std::span<const double> weights, std::span<double> out) const {
    const std::size_t first = inner_->size();
    inner_->multiply(weights.first(first), out.first(first));
    for (std::size_t a = first; a < size_; ++a) {
        const double* row = &rows_[(a - first) * size_];
        out[a] = std::inner_product(weights.begin(), weights.end(), row, 0.0);
        for (std::size_t j = 0; j < first; ++j) out[j] += weights[a] * row[j];
    }
}

double BorderedKernelMatrix::megabytes() const {
    return inner_->megabytes() + static_cast<double>(rows_.size() * sizeof(double)) / (1 << 20);
}

std::unique_ptr<KernelMatrix> make_kernel_matrix(Kernel kernel, const PointArrays& points, Products products,
                                                 double tolerance, const Work& work) {
    if (products == Products::direct || (products == Products::automatic && points.size() <= kMostDirect))
        return std::make_unique<DirectKernelMatrix>(kernel, points, work);
    return std::make_unique<H2KernelMatrix>(kernel, points, H2Options{.tolerance = tolerance}, work);
}

}  // namespace kontur
