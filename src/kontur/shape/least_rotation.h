// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

namespace kontur {

/// Index at which the ring must start to be the first in lexicographical order. Source: Shiloach 1981.
template <class Ring>
std::size_t least_rotation(const Ring& ring) {
    const std::size_t count = ring.size();
    std::size_t best = 0, other = 1;
    for (std::size_t same = 0; best < count && other < count && same < count;) {
        const auto &a = ring[(best + same) % count], &b = ring[(other + same) % count];
        if (a == b) {
            ++same;
            continue;
        }
        (a < b ? other : best) += same + 1;
        if (best == other) ++other;
        same = 0;
    }
    return std::min(best, other);
}

}  // namespace kontur
