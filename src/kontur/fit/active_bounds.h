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

/// The bounds, and at which limit of theirs f is held. Keeps a reference to them and to the drawn points.
class ActiveBounds {
public:
    ActiveBounds(const std::vector<Bound>& bounds, const std::vector<BoundaryPoint>& drawn);

    /// Holds f at these to begin with. Throws Error(invalid_input) for one that is not there.
    void hold(std::span<const std::size_t> bounds);

    /// Holds f where it leaves its interval by more than counts, and lets it go where it keeps it by itself; true if another
    /// solve would move f by more than counts: than the tolerance, and than 3 % of the noise of a bound that f leaves, which
    /// says how well it is known, or `held_counts` of it where f would keep a bound that is held. The first are held only
    /// where f is farthest off in a surrounding as wide as it is far to what was drawn.
    bool update(const ImplicitFunction& function, double tolerance_mm, double held_counts, const Work& work);

    /// Whether f is held anywhere where it need not be.
    bool holds_any() const;
    void append_to(std::vector<PointConstraint>& points) const;

private:
    enum class Activity : std::uint8_t { no, at_least, at_most, always };

    /// A bound whose interval f leaves.
    struct Left {
        double excess_mm;
        std::size_t bound;
        Activity limit;
    };

    std::vector<Left> farthest_off(std::vector<Left> left) const;

    const std::vector<Bound>& bounds_;
    const std::vector<BoundaryPoint>& drawn_;
    std::vector<Vec3> positions_;
    std::vector<Activity> activity_;
};

}  // namespace kontur
