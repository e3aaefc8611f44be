// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// Points arranged for the question how far the nearest one is: a balanced k-d tree stored in place. Exact; building
/// costs O(n log n), a query O(log n) near the points and more the farther away it is.
/// Source: Friedman, Bentley and Finkel 1977; distance to the cell updated step by step as in Arya and Mount 1993.
class PointTree {
public:
    explicit PointTree(std::vector<Vec3> points);

    /// Distance from `p` to the nearest point; infinity when there are none. Safe to call from any thread.
    double distance_to(const Vec3& p) const noexcept;

private:
    struct Query;

    void build(std::size_t begin, std::size_t end);
    void search(std::size_t begin, std::size_t end, const Vec3& to_cell, Query& query) const noexcept;

    std::vector<Vec3> points_;              ///< of [begin, end) the middle one splits; smaller ones lie before it
    std::vector<std::uint8_t> split_axis_;  ///< of the point at the same place
};

}  // namespace kontur
