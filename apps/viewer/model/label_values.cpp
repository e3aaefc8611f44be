// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/label_values.h"

#include <algorithm>
#include <set>

namespace kontur::viewer {

std::vector<std::int64_t> label_values(std::span<const std::optional<std::int64_t>> own) {
    std::set<std::int64_t> taken;
    std::vector<std::int64_t> values(own.size());
    for (std::size_t n = 0; n < own.size(); ++n)
        if (own[n] && taken.insert(*own[n]).second) values[n] = *own[n];
    std::int64_t next = 1;
    for (std::int64_t& value : values) {
        if (value != 0) continue;
        while (taken.contains(next)) ++next;
        value = next++;
    }
    return values;
}

const Structure* owner_of_label(const State& state, std::int64_t value, Id except) {
    const auto found = std::ranges::find_if(
        state.structures, [&](const auto& item) { return item.first != except && item.second.label_value == value; });
    return found == state.structures.end() ? nullptr : &found->second;
}

}  // namespace kontur::viewer
