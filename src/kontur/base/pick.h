// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <ranges>
#include <vector>

namespace kontur {

/// from[i] for each of the indices, in their order.
template <std::ranges::random_access_range Values>
std::vector<std::ranges::range_value_t<Values>> pick(const Values& from, const std::vector<std::size_t>& indices) {
    std::vector<std::ranges::range_value_t<Values>> picked;
    picked.reserve(indices.size());
    for (const std::size_t i : indices) picked.push_back(from[i]);
    return picked;
}

}  // namespace kontur
