// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/painted_runs.h"

#include <algorithm>
#include <limits>

namespace kontur {
namespace {

using Length = std::uint16_t;  // of runs; longer ones count as this long
constexpr Length kLongest = std::numeric_limits<Length>::max();

constexpr Length kLeastOfSolid = 3;

Length one_more(Length length) { return length == kLongest ? length : static_cast<Length>(length + 1); }

/// Lengths of the runs of set values along a row of a plane, given with its stride.
void measure_runs(const std::uint8_t* values, Length* lengths, std::int64_t count, std::int64_t stride) {
    for (std::int64_t n = 0; n < count;) {
        std::int64_t end = n;
        while (end < count && values[end * stride]) ++end;
        for (std::int64_t m = n; m < end; ++m)
            lengths[m * stride] = static_cast<Length>(std::min<std::int64_t>(end - n, kLongest));
        n = std::max(end, n + 1);
    }
}

/// Lengths of the runs along k of the painted voxels, in memory order.
std::vector<Length> runs_across_planes(const Mask& mask) {
    const auto plane = static_cast<std::size_t>(mask.grid.size.i * mask.grid.size.j);
    std::vector<Length> lengths, along(plane);
    for (std::size_t n = 0; n < mask.values.size(); ++n) {
        Length& length = along[n % plane];
        length = mask.values[n] ? one_more(length) : Length{0};
        if (length > 0) lengths.push_back(length);
    }
    // Back, so that each voxel learns how long its run became.
    std::fill(along.begin(), along.end(), Length{0});
    std::size_t rank = lengths.size();
    for (std::size_t n = mask.values.size(); n-- > 0;) {
        Length& length = along[n % plane];
        if (!mask.values[n]) length = 0;
        else lengths[rank - 1] = length = std::max(length, lengths[rank - 1]), --rank;
    }
    return lengths;
}

std::uint8_t shortest(Length i, Length j, Length k) {
    const Length least = std::min({i, j, k});
    return static_cast<std::uint8_t>((i == least) | (j == least) << 1 | (k == least) << 2 |
                                     (least >= kLeastOfSolid ? kSolid : 0));
}

}  // namespace

std::vector<std::uint8_t> shortest_runs(const Mask& mask) {
    const Index3& size = mask.grid.size;
    std::vector<std::uint8_t> known(mask.values.size());
    const std::vector<Length> across = runs_across_planes(mask);
    const std::int64_t plane = size.i * size.j;
    std::vector<Length> along_i(static_cast<std::size_t>(plane)), along_j(along_i.size());
    std::size_t rank = 0;
    for (std::int64_t k = 0; k < size.k; ++k) {
        const std::uint8_t* const values = mask.values.data() + k * plane;
        for (std::int64_t j = 0; j < size.j; ++j)
            measure_runs(values + j * size.i, &along_i[static_cast<std::size_t>(j * size.i)], size.i, 1);
        for (std::int64_t i = 0; i < size.i; ++i)
            measure_runs(values + i, &along_j[static_cast<std::size_t>(i)], size.j, size.i);
        for (std::int64_t n = 0; n < plane; ++n)
            if (values[n])
                known[static_cast<std::size_t>(k * plane + n)] =
                    shortest(along_i[static_cast<std::size_t>(n)], along_j[static_cast<std::size_t>(n)], across[rank++]);
    }
    return known;
}

}  // namespace kontur
