// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "experiments.h"

namespace kontur::bench {

/// How the time and memory to solve grow with the number of constraints, from 1,000 to `most`: one row per system of
/// dense_liver_case, drawn in parallel planes exactly and, up to 200,000 constraints, in orthogonal planes by hand.
Json growth(std::size_t most, int repeat);

}  // namespace kontur::bench
