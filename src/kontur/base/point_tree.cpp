// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/point_tree.h"

#include <algorithm>
#include <utility>

namespace kontur {
namespace {

int widest_axis(const Vec3& size) { return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2; }

}  // namespace

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

}  // namespace kontur
