// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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
    double distance_to(const Vec3& p) const noexcept {
        return std::sqrt(least(p, [](const Vec3& d) { return dot(d, d); }));
    }

    /// The least of cost(q - p) over all points q, where the cost is nowhere less than the squared distance: of points that
    /// are near but do not count. Infinity when there are none.
    template <class Cost>
    double least(const Vec3& p, const Cost& cost) const noexcept {
        double found = std::numeric_limits<double>::infinity();
        search(0, points_.size(), {}, p, cost, found);
        return found;
    }

private:
    static constexpr std::size_t kLeafSize = 8;  // fewer points are faster looked through than split

    void build(std::size_t begin, std::size_t end);

    /// `to_cell` runs from the cell of [begin, end) to p, axis by axis; 0 where p is level with the cell.
    template <class Cost>
    void search(std::size_t begin, std::size_t end, const Vec3& to_cell, const Vec3& p, const Cost& cost,
                double& found) const noexcept {
        if (end - begin <= kLeafSize) {
            for (std::size_t i = begin; i < end; ++i) found = std::min(found, cost(points_[i] - p));
            return;
        }
        const std::size_t middle = begin + (end - begin) / 2;
        const int axis = split_axis_[middle];
        const double beyond = p[axis] - points_[middle][axis];
        const bool below = beyond < 0;
        search(below ? begin : middle + 1, below ? middle : end, to_cell, p, cost, found);
        found = std::min(found, cost(points_[middle] - p));
        Vec3 to_far_cell = to_cell;
        to_far_cell[axis] = beyond;
        if (dot(to_far_cell, to_far_cell) < found)
            search(below ? middle + 1 : begin, below ? end : middle, to_far_cell, p, cost, found);
    }

    std::vector<Vec3> points_;              ///< of [begin, end) the middle one splits; smaller ones lie before it
    std::vector<std::uint8_t> split_axis_;  ///< of the point at the same place
};

}  // namespace kontur
