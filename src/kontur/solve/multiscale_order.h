// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/function/kernel.h"
#include "kontur/function/point_arrays.h"

namespace kontur {

/// Points from coarse to fine: `order` lists the points so that every prefix is spread evenly; level l fills
/// [level_begin[l], level_begin[l + 1]) and its points are about `spacing[l]` apart.
struct MultiscaleOrder {
    std::vector<std::int32_t> order;
    std::vector<std::int32_t> level_begin;
    std::vector<double> spacing;
};

/// Every level takes one point, the one nearest to the centre, of each octree cell that coarser levels left empty.
MultiscaleOrder multiscale_order(const PointArrays& points);

}  // namespace kontur
