// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kontur/base/geometry.h"

namespace kontur {

/// A number in [0, 1) for every cell of a lattice, evenly in whatever part of it: those below a share of 1 are this share of
/// the cells, and one cell more or less leaves the others as they are. Source: the additive recurrence of Roberts 2018.
inline double place_in_turn(const Index3& at) {
    const double sum = 0.8191725133961645 * static_cast<double>(at.i) + 0.6710436067037893 * static_cast<double>(at.j) +
                       0.5497004779019703 * static_cast<double>(at.k);
    return sum - std::floor(sum);
}

}  // namespace kontur
