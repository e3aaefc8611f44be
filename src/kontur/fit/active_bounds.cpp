// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/active_bounds.h"

#include <algorithm>

namespace kontur {

ActiveBounds::ActiveBounds(const std::vector<Bound>& bounds) : bounds_(bounds), held_(bounds.size(), Held::no) {
    for (const Bound& bound : bounds) positions_.push_back(bound.position);
}

bool ActiveBounds::update(const ImplicitFunction& function, double tolerance_mm, const Work& work) {
    std::vector<double> values(bounds_.size());
    function.values(positions_, values, work);
    bool changed = false;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        const double slack = held_[i] == Held::no ? tolerance_mm : 0;
        const Held next = values[i] > bounds_[i].most_mm + slack    ? Held::at_most
                          : values[i] < bounds_[i].least_mm - slack ? Held::at_least
                                                                    : Held::no;
        changed = changed || next != held_[i];
        held_[i] = next;
    }
    return changed;
}

bool ActiveBounds::holds_any() const {
    return std::ranges::any_of(held_, [](Held held) { return held != Held::no; });
}

void ActiveBounds::append_to(std::vector<PointConstraint>& points) const {
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        const Bound& bound = bounds_[i];
        if (held_[i] == Held::no) continue;
        points.push_back({.position = bound.position,
                          .value = held_[i] == Held::at_most ? bound.most_mm : bound.least_mm,
                          .noise_mm = bound.noise_mm});
    }
}

}  // namespace kontur
