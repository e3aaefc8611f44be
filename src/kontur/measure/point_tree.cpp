// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/point_tree.h"

#include <algorithm>
#include <utility>

namespace kontur {
namespace {

constexpr std::size_t kLeafSize = 8;  // fewer points are faster looked through than split

int widest_axis(const Vec3& size) { return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2; }

}  // namespace

struct PointTree::Query {
    Vec3 p;
    double nearest_squared;
};

PointTree::PointTree(std::vector<Vec3> points) : points_(std::move(points)), split_axis_(points_.size()) {
    build(0, points_.size());
}

void PointTree::build(std::size_t begin, std::size_t end) {
    if (end - begin <= kLeafSize) return;
    const auto first = points_.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = points_.begin() + static_cast<std::ptrdiff_t>(end);
    const int axis = widest_axis(bounding_box(std::span(first, last)).size());
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(first, points_.begin() + static_cast<std::ptrdiff_t>(middle), last,
                     [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    split_axis_[middle] = static_cast<std::uint8_t>(axis);
    build(begin, middle);
    build(middle + 1, end);
}

double PointTree::distance_to(const Vec3& p) const noexcept {
    Query query{p, std::numeric_limits<double>::infinity()};
    search(0, points_.size(), {}, query);
    return std::sqrt(query.nearest_squared);
}

/// `to_cell` runs from the cell of [begin, end) to the query point, axis by axis; 0 where the point is level with the cell.
void PointTree::search(std::size_t begin, std::size_t end, const Vec3& to_cell, Query& query) const noexcept {
    const auto visit = [&](const Vec3& point) {
        const Vec3 d = query.p - point;
        query.nearest_squared = std::min(query.nearest_squared, dot(d, d));
    };
    if (end - begin <= kLeafSize) {
        for (std::size_t i = begin; i < end; ++i) visit(points_[i]);
        return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const int axis = split_axis_[middle];
    const double beyond = query.p[axis] - points_[middle][axis];
    const bool below = beyond < 0;
    search(below ? begin : middle + 1, below ? middle : end, to_cell, query);
    visit(points_[middle]);
    Vec3 to_far_cell = to_cell;
    to_far_cell[axis] = beyond;
    if (dot(to_far_cell, to_far_cell) < query.nearest_squared)
        search(below ? middle + 1 : begin, below ? end : middle, to_far_cell, query);
}

}  // namespace kontur
