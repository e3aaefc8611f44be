// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace kontur {

/// How much an image had to do with how far a correction is carried.
struct ImageReach {
    double weight = 0;       ///< 0: nothing; at most kMostImageWeight
    std::size_t planes = 0;  ///< left out, one after another; 0 where fewer than three were looked at
    std::int64_t wrong_without = 0, wrong_with = 0;  ///< voxels in them, each by what the other planes say
};

/// For people, in one sentence.
std::string sentence(const ImageReach& reach);

}  // namespace kontur
