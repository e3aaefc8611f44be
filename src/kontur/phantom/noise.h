// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/phantom/random.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// Image noise, a pure function of seed and voxel: white noise smoothed by (1 2 1) along i and j and (1 4 1) along k, scaled
/// to the given standard deviation.
class CorrelatedNoise {
public:
    CorrelatedNoise(const Grid& grid, std::uint64_t seed, double standard_deviation)
        : size_(grid.size), seed_(mix_bits(seed)), standard_deviation_(standard_deviation) {}

    std::vector<double> row(std::int64_t j, std::int64_t k) const {
        if (standard_deviation_ == 0) return std::vector<double>(static_cast<std::size_t>(size_.i));
        std::vector<double> column_sums(static_cast<std::size_t>(size_.i + 2));
        for (int dk = -1; dk <= 1; ++dk)
            for (int dj = -1; dj <= 1; ++dj) {
                const double weight = (dj == 0 ? 2 : 1) * (dk == 0 ? 4 : 1);
                const std::uint64_t row_seed =
                    mix_bits(seed_ ^ mix_bits(static_cast<std::uint64_t>(j + dj + size_.j * (k + dk))));
                for (std::size_t i = 0; i < column_sums.size(); ++i) column_sums[i] += weight * white(row_seed, i);
            }
        // Variances of the three kernels: 1 + 4 + 1, 1 + 4 + 1 and 1 + 16 + 1.
        const double scale = standard_deviation_ / std::sqrt(6.0 * 6.0 * 18.0);
        std::vector<double> result(static_cast<std::size_t>(size_.i));
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] = scale * (column_sums[i] + 2 * column_sums[i + 1] + column_sums[i + 2]);
        return result;
    }

private:
    /// Mean 0, variance 1: the sum of four uniform 16-bit numbers, which the smoothing turns all but normal.
    static double white(std::uint64_t row_seed, std::uint64_t i) {
        const std::uint64_t bits = mix_bits(row_seed + i);
        const auto sum = (bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48);
        const double deviation = 65536 / std::sqrt(3.0);  // of the sum: sqrt(4 / 12) * 65536
        return (static_cast<double>(sum) - 2 * 65535.0) / deviation;
    }

    Index3 size_;
    std::uint64_t seed_;
    double standard_deviation_;
};

}  // namespace kontur
