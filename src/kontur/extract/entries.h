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

/// Where the surface through `starts` (mm) comes into the grid across its border, and the grid's corners that may lie inside
/// of it. A search that begins at starts within a grid misses the parts that touch none of these. The surface is followed
/// outside of the grid too, on a lattice of cubes as wide as the grid's smallest spacing, but at least 1 / 250 of the
/// starts' box, so that the cost is bounded however small the voxels are. No start outside of the grid, or none on any side
/// of which the grid lies: nothing, at no cost.
Entries entries(const ImplicitFunction& function, const Grid& grid, std::span<const Vec3> starts, const Work& work = {});

}  // namespace kontur
