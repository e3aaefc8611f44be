// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/box_tree.h"

#include <cmath>

namespace kontur {

BoxTree::BoxTree(std::vector<Box2> boxes) : boxes_(std::move(boxes)) {
    for (std::size_t i = 0; i < boxes_.size(); ++i)
        if (boxes_[i].low[0] <= boxes_[i].high[0] && boxes_[i].low[1] <= boxes_[i].high[1]) order_.push_back(i);
    nodes_.reserve(2 * order_.size());
    if (!order_.empty()) add_node(0, order_.size());
}

/// Halves by the middles of the boxes along the longer side of theirs: as deep as the logarithm of the number, whatever lies
/// where.
std::size_t BoxTree::add_node(std::size_t begin, std::size_t end) {
    const std::size_t added = nodes_.size();
    nodes_.push_back({{}, begin, end});
    Box2 box, middles;
    const auto middle = [&](std::size_t i) {
        Point2 m{boxes_[i].low[0] / 2 + boxes_[i].high[0] / 2, boxes_[i].low[1] / 2 + boxes_[i].high[1] / 2};
        for (double& coordinate : m)
            if (std::isnan(coordinate)) coordinate = 0;  // of an infinite box; what has no order cannot be halved
        return m;
    };
    for (std::size_t i = begin; i < end; ++i) {
        box.extend(boxes_[order_[i]]);
        middles.extend(middle(order_[i]));
    }
    nodes_[added].box = box;
    if (end - begin == 1) return added;
    const std::size_t axis = middles.high[0] - middles.low[0] >= middles.high[1] - middles.low[1] ? 0 : 1;
    const std::size_t half = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(half), at(end), [&](std::size_t a, std::size_t b) {
        return std::pair(middle(a)[axis], a) < std::pair(middle(b)[axis], b);
    });
    const std::size_t first = add_node(begin, half), second = add_node(half, end);
    nodes_[added].first_child = first;
    nodes_[added].second_child = second;
    return added;
}

}  // namespace kontur
