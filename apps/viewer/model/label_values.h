// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "viewer/model/model.h"

namespace kontur::viewer {

/// Values that label maps give to structures, in the order of these: those of their own, and for the others the smallest
/// ones, from 1 on, that none has. Of two with the same own value the first keeps it.
std::vector<std::int64_t> label_values(std::span<const std::optional<std::int64_t>> own);

/// Which other structure has this label value of its own; null where none has.
const Structure* owner_of_label(const State& state, std::int64_t value, Id except);

}  // namespace kontur::viewer
