// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "kontur/shape/predicates.h"

namespace kontur {

/// A box in a plane, mm; empty until it is extended.
struct Box2 {
    Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Point2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

    void extend(const Point2& p) {
        for (const std::size_t axis : {0u, 1u}) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
    void extend(const Box2& other) {
        for (const std::size_t axis : {0u, 1u}) {
            low[axis] = std::min(low[axis], other.low[axis]);
            high[axis] = std::max(high[axis], other.high[axis]);
        }
    }
    bool contains(const Point2& p) const { return low[0] <= p[0] && p[0] <= high[0] && low[1] <= p[1] && p[1] <= high[1]; }
    /// Whether they have a point in common.
    bool meets(const Box2& other) const {
        return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] && other.low[1] <= high[1];
    }
    /// Squared distance of p from the nearest place of the box; 0 inside.
    double distance2(const Point2& p) const {
        double sum = 0;
        for (const std::size_t axis : {0u, 1u}) {
            const double away = std::max({low[axis] - p[axis], p[axis] - high[axis], 0.0});
            sum += away * away;
        }
        return sum;
    }
};

/// Finds those of many boxes that matter without looking at all of them. Empty ones never do. Built in O(n log n).
class BoxTree {
public:
    explicit BoxTree(std::vector<Box2> boxes = {});

    /// Calls visit(index) for every box whose key(box) is at most limit() by the time it is reached, the lesser of two keys
    /// first; a box must not have a lesser key than one around it. limit() may fall as boxes are visited.
    template <class Key, class Limit, class Visit>
    void visit(const Key& key, const Limit& limit, const Visit& visit) const {
        if (!nodes_.empty()) descend(0, key(nodes_[0].box), key, limit, visit);
    }

    /// The boxes that contain p, in no particular order.
    template <class Visit>
    void visit_around(const Point2& p, const Visit& visit_box) const {
        visit([&](const Box2& box) { return box.contains(p) ? 0.0 : 1.0; }, [] { return 0.0; }, visit_box);
    }

    /// The boxes that meet another one, in no particular order.
    template <class Visit>
    void visit_meeting(const Box2& other, const Visit& visit_box) const {
        visit([&](const Box2& box) { return box.meets(other) ? 0.0 : 1.0; }, [] { return 0.0; }, visit_box);
    }

private:
    /// Boxes order_[begin, end); without children where there is but one.
    struct Node {
        Box2 box;
        std::size_t begin, end;
        std::size_t first_child = 0, second_child = 0;
    };

    std::size_t add_node(std::size_t begin, std::size_t end);

    template <class Key, class Limit, class Visit>
    void descend(std::size_t n, double own_key, const Key& key, const Limit& limit, const Visit& visit) const {
        if (!(own_key <= limit())) return;
        const Node& node = nodes_[n];
        if (node.first_child == 0) {
            visit(order_[node.begin]);
            return;
        }
        std::pair<double, std::size_t> near{key(nodes_[node.first_child].box), node.first_child},
            far{key(nodes_[node.second_child].box), node.second_child};
        if (far.first < near.first) std::swap(near, far);
        descend(near.second, near.first, key, limit, visit);
        descend(far.second, far.first, key, limit, visit);
    }

    std::vector<Box2> boxes_;
    std::vector<std::size_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace kontur
