// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/grid.h"

namespace kontur {

struct Entries {
    std::vector<Vec3> points;      ///< mm; more starts for a search on the grid
    std::int64_t evaluations = 0;  ///< function values that finding them took
};

/// The places where the surface through `starts` (mm) enters the grid across its border, and the grid's corners that may
/// lie inside of it. A search from the starts within a grid misses the parts that touch none of these. Outside, the
/// surface is followed on a lattice of cubes as wide as the grid's smallest spacing, and at least 1 / 250 of the starts'
/// box. This bounds the cost. Nothing, at no cost, without starts outside of the grid, or where the grid lies on no side
/// of them.
Entries entries(const ImplicitFunction& function, const Grid& grid, std::span<const Vec3> starts, const Work& work = {});

}  // namespace kontur
