// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kontur/drawing/boundary_point.h"
#include "kontur/solve/constraint_set.h"

namespace kontur {

/// A constraint at a single point.
struct PointConstraint {
    Vec3 position;
    double value;
    double trust = 1;     ///< > 0: how closely f is to follow, against smoothness
    double noise_mm = 0;  ///< >= 0: standard deviation of the value
    double extent = 1;    ///< in (0, 1], as a boundary point's
};

/// By itself as the paper has it; `fit` has its own (FitOptions).
struct PlaceOptions {
    double normal_offset_mm = 1.0;  ///< length d > 0 of the normal constraints
    bool both_sides = false;        ///< normal constraints inside as well as outside, at every second point or so
    double normal_spacing_mm = 0;   ///< along a line, from one point with normal constraints to the next, at least
    double slope_noise = 0;         ///< >= 0, standard deviation of the slopes: of a normal constraint this times d, in mm
    double merge_distance_mm = 0;   ///< a constraint closer than this to an earlier one is left out (0: only exact copies)
};

struct PlacedConstraints {
    ConstraintSet constraints;
    std::size_t merged = 0;  ///< constraints left out because they (nearly) repeat others
};

/// Throws Error(invalid_input) for an offset that is not above 0, a spacing, a merge distance or a noise below 0, and what
/// is not finite of them.
void check_place_options(const PlaceOptions& options);
/// Throws Error(invalid_input) unless there is one slope in (0, 1] for each of the points.
void check_slopes(std::span<const double> slopes, std::size_t points);

/// Boundary constraints f = 0 at all points, and beside them normal constraints: f = -d s at the distance d
/// outside along the in-plane normal. Then the single points. d is the offset, but no more than half of the
/// point's gap, so that in a narrow cleft each wall keeps its side. `slopes` holds s in (0, 1], one per
/// point: how fast f falls along the in-plane normal. For a distance-like f this is the cosine of the
/// surface's tilt against the contour's plane. All ones is the paper's choice.
///
/// A normal constraint on the outside alone pulls the surface inwards wherever f does not reach it exactly.
/// With `both_sides` about every second point has two: also f = +d s at the distance d inside, no more than
/// half of the depth. What they miss cancels at the line, and the number of constraints stays. The choice
/// of points does not depend on where the line begins (spread_along). None are neighbours, or nearer to
/// each other than the spacing. Each stands for half of the points on the way to the next one; the more
/// there are, the less is its noise. Offset, spacing and merge distance are as much smaller as a point's
/// extent.
///
/// Near-duplicates make the system singular or contradictory (Turk & O'Brien 2002). So a constraint within
/// the merge distance of another one is dropped. Boundary constraints come first and win, among them those
/// that stand for more of their line. Throws Error(invalid_input) as the two checks do, and for coordinates
/// and values that are not finite, a gap that is not above 0, and a trust that is not finite and above 0.
PlacedConstraints place_constraints(std::span<const BoundaryPoint> points, std::span<const double> slopes,
                                    std::span<const PointConstraint> single_points, const PlaceOptions& options = {});

}  // namespace kontur
