// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kontur/base/smooth_step.h"
#include "kontur/bounds/bounds.h"
#include "kontur/bounds/drawn_regions.h"

namespace kontur {

/// The places of a plane that are asked what it says of them: a lattice of an eighth of the radius of the ball around all
/// that was drawn, in one and a quarter of that ball.
class PlaneLattice {
public:
    /// `off_mm`: of the plane from the ball's centre.
    PlaneLattice(const Ball3& ball, double off_mm) : step_mm_(ball.radius / 8) {
        const double reach = 1.25 * ball.radius;
        extent_mm_ = std::abs(off_mm) < reach ? std::sqrt(reach * reach - off_mm * off_mm) : -1;
    }

    double step_mm() const { return step_mm_; }

    /// `visit(x_mm, y_mm)` from the foot of the ball's centre, along two axes of the plane.
    template <class Visit>
    void for_each_place(Visit visit) const {
        if (extent_mm_ < 0) return;
        const auto steps = static_cast<int>(extent_mm_ / step_mm_);
        for (int row = -steps; row <= steps; ++row)
            for (int column = -steps; column <= steps; ++column)
                if (std::hypot(row * step_mm_, column * step_mm_) <= extent_mm_) visit(column * step_mm_, row * step_mm_);
    }

private:
    double step_mm_, extent_mm_;
};

/// f at a place of a lattice that is known to lie so far outside: a quarter of that, since walls that stand oblique to the
/// plane are nearer than its lines. Of the noise, half or twice the eighth of a step changes nothing; a whole step leaves
/// islands between two planes that show the object there (bench/shapes.py).
inline Bound outside_bound(const Vec3& place, double outside_mm, double step_mm, double belief) {
    return {.position = place,
            .most_mm = -0.25 * outside_mm,
            .noise_mm = faded(0.1 * std::max(outside_mm, step_mm / 8), belief)};
}

/// How much another plane crosses one: 0 for a parallel one, 1 from 20 degrees on. From 30 on 81 organ drawings change by
/// .00002 in the mean, one by .0008; arches and helices whose rings are 3 radii apart lose .001 and .0025.
inline double crossing(const Vec3& normal, const Vec3& other) {
    constexpr double kSlantedSine2 = 0.12;
    const double cosine = dot(normal, other);
    return smooth_step(0, kSlantedSine2, 1 - cosine * cosine);
}

/// How far outside a place of one plane is, for each mm from what another plane shows of the object: beyond a parallel one
/// the object may go on.
inline double outside_per_mm(const Vec3& normal, const Vec3& other) {
    constexpr double kParallel = 0.1;
    return kParallel + (1 - kParallel) * crossing(normal, other);
}

}  // namespace kontur
