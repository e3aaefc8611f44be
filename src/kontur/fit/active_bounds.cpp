// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/active_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kontur/base/error.h"
#include "kontur/base/point_tree.h"

namespace kontur {

ActiveBounds::ActiveBounds(const std::vector<Bound>& bounds, const std::vector<BoundaryPoint>& points)
    : bounds_(bounds), points_(points), activity_(bounds.size(), Activity::no) {
    for (std::size_t b = 0; b < bounds.size(); ++b) {
        positions_.push_back(bounds[b].position);
        if (bounds[b].least_mm == bounds[b].most_mm) activity_[b] = Activity::always;
    }
}

void ActiveBounds::hold(std::span<const std::size_t> bounds) {
    for (const std::size_t b : bounds) {
        if (b >= bounds_.size())
            throw Error(ErrorKind::invalid_input,
                        fmt::format("bound {} is to be held to begin with; there are {}", b + 1, bounds_.size()));
        if (activity_[b] == Activity::no)
            activity_[b] = std::isfinite(bounds_[b].most_mm) ? Activity::at_most : Activity::at_least;
    }
}

bool ActiveBounds::update(const ImplicitFunction& function, double tolerance_mm, double held_counts, const Work& work) {
    std::vector<double> values(bounds_.size());
    function.values(positions_, values, work);
    const bool are_first = !holds_any();
    std::vector<Violation> violations;
    bool counts = false;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        if (activity_[i] == Activity::always) continue;
        const double above = values[i] - bounds_[i].most_mm, below = bounds_[i].least_mm - values[i];
        const double noise = bounds_[i].noise_mm;
        if (activity_[i] == Activity::no) {
            const double excess = std::max(above, below);
            const bool has_its_side =
                bounds_[i].by_side && values[i] * (above > below ? bounds_[i].most_mm : bounds_[i].least_mm) > 0;
            if (!has_its_side && excess > std::max(tolerance_mm, kCounts * noise))
                violations.push_back({excess, i, above > below ? Activity::at_most : Activity::at_least});
        } else if (const double excess = activity_[i] == Activity::at_most ? above : below; excess <= 0) {
            activity_[i] = Activity::no;
            counts = counts || excess < -std::max(tolerance_mm, held_counts * noise);
        }
    }
    counts = counts || !violations.empty();
    if (are_first && !violations.empty()) violations = farthest_off(std::move(violations));
    for (const Violation& one : violations) activity_[one.bound] = one.limit;
    return counts;
}

/// Those that are farther off than any other in their surroundings. Held, they mostly keep f there; holding all at first
/// takes many solves to let most of them go again.
std::vector<ActiveBounds::Violation> ActiveBounds::farthest_off(std::vector<Violation> violations) const {
    std::sort(violations.begin(), violations.end(), [](const Violation& a, const Violation& b) {
        return std::tie(b.excess_mm, a.bound) < std::tie(a.excess_mm, b.bound);
    });
    std::vector<Vec3> positions(points_.size());
    std::transform(points_.begin(), points_.end(), positions.begin(), [](const BoundaryPoint& p) { return p.position; });
    const PointTree lines(std::move(positions));
    std::vector<Violation> farthest;
    for (const Violation& one : violations) {
        const Vec3& place = positions_[one.bound];
        const double around = lines.distance_to(place);
        if (std::ranges::none_of(farthest,
                                 [&](const Violation& f) { return distance(positions_[f.bound], place) < around; }))
            farthest.push_back(one);
    }
    return farthest;
}

bool ActiveBounds::holds_any() const {
    return std::ranges::any_of(
        activity_, [](Activity activity) { return activity == Activity::at_least || activity == Activity::at_most; });
}

void ActiveBounds::append_to(std::vector<PointConstraint>& points) const {
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        const Bound& bound = bounds_[i];
        if (activity_[i] == Activity::no) continue;
        points.push_back({.position = bound.position,
                          .value = activity_[i] == Activity::at_least ? bound.least_mm : bound.most_mm,
                          .noise_mm = bound.noise_mm,
                          .extent = bound.extent});
    }
}

}  // namespace kontur
