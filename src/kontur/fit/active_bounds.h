// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/bounds/bounds.h"
#include "kontur/drawing/boundary_point.h"
#include "kontur/fit/constraints.h"
#include "kontur/function/implicit_function.h"

namespace kontur {

/// Of a bound's noise, what f may leave it by. Three times as much lets the volume jump by 4 % where one of two planes
/// turns, a third of it changes nothing but that some drawings take one more solve of all points.
inline constexpr double kCounts = 0.03;

/// The bounds, and at which limit of theirs f is held. Keeps a reference to them and to the drawn points.
class ActiveBounds {
public:
    ActiveBounds(const std::vector<Bound>& bounds, const std::vector<BoundaryPoint>& points);

    /// Holds f at these to begin with. Throws Error(invalid_input) for one that is not there.
    void hold(std::span<const std::size_t> bounds);

    /// Holds f where it leaves its interval by more than counts, and releases it where it stays inside by itself. True if
    /// another solve would move f by more than counts: the tolerance, and 3 % of the noise of a bound that f leaves, or
    /// `held_counts` of the noise of one that is held needlessly. At first f is held only where it is farthest off, within a
    /// surrounding as wide as the distance to the drawn points.
    bool update(const ImplicitFunction& function, double tolerance_mm, double held_counts, const Work& work);

    /// Whether f is held anywhere where it need not be.
    bool holds_any() const;
    void append_to(std::vector<PointConstraint>& points) const;

private:
    enum class Activity : std::uint8_t { no, at_least, at_most, always };

    /// A bound whose interval f leaves.
    struct Violation {
        double excess_mm;
        std::size_t bound;
        Activity limit;
    };

    std::vector<Violation> farthest_off(std::vector<Violation> violations) const;

    const std::vector<Bound>& bounds_;
    const std::vector<BoundaryPoint>& points_;
    std::vector<Vec3> positions_;
    std::vector<Activity> activity_;
};

}  // namespace kontur
