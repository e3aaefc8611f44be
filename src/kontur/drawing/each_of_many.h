// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

namespace kontur {

/// How many places each of `count` lines or regions gets, of which one among few gets `each`: from 100 on they share what
/// can be solved, and each keeps a quarter.
inline double each_of_many(std::size_t count, double each) {
    constexpr double kMany = 100, kLeast = 0.25;
    return each * std::clamp(kMany / static_cast<double>(std::max<std::size_t>(count, 1)), kLeast, 1.0);
}

}  // namespace kontur
