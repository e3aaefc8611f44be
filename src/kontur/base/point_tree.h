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
        Query<Cost> query{p, cost};
        search(0, points_.size(), {}, query);
        return query.least;
    }

private:
    static constexpr std::size_t kLeafSize = 8;  // fewer points are faster looked through than split

    template <class Cost>
    struct Query {
        Vec3 place;
        const Cost& cost;
        double least = std::numeric_limits<double>::infinity();  ///< of the points so far

        void offer(const Vec3& point) { least = std::min(least, cost(point - place)); }
    };

    void build(std::size_t begin, std::size_t end);

    /// `to_cell` runs from the cell of [begin, end) to the place, axis by axis; 0 where it is level with the cell.
    template <class Cost>
    void search(std::size_t begin, std::size_t end, const Vec3& to_cell, Query<Cost>& query) const noexcept {
        if (end - begin <= kLeafSize) {
            for (std::size_t i = begin; i < end; ++i) query.offer(points_[i]);
            return;
        }
        const std::size_t middle = begin + (end - begin) / 2;
        const int axis = split_axis_[middle];
        const double beyond = query.place[axis] - points_[middle][axis];
        const bool below = beyond < 0;
        search(below ? begin : middle + 1, below ? middle : end, to_cell, query);
        query.offer(points_[middle]);
        Vec3 to_far_cell = to_cell;
        to_far_cell[axis] = beyond;
        if (dot(to_far_cell, to_far_cell) < query.least)
            search(below ? middle + 1 : begin, below ? end : middle, to_far_cell, query);
    }

    std::vector<Vec3> points_;              ///< of [begin, end) the middle one splits; smaller ones lie before it
    std::vector<std::uint8_t> split_axis_;  ///< of the point at the same place
};

}  // namespace kontur
