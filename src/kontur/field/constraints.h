// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

inline constexpr std::int32_t kNoContour = -1;

/// A point of the surface that takes part in the fit, with what was drawn of the surface's direction there.
struct BoundaryPoint {
    Vec3 position;           ///< mm
    Vec3 inplane_normal{};   ///< unit, outward, in the contour's plane (Eq. 7); zero: not known, no normal constraint
    Vec3 plane_normal{};     ///< unit normal of the contour's plane: where the surface may tilt; zero: it may not
    std::int32_t contour{};  ///< index into ContourSet::contours; kNoContour for a single point
    double trust = 1;        ///< > 0: how closely the surface is to follow, against smoothness
    double gap_mm = std::numeric_limits<double>::infinity();  ///< along the normal to the next drawn line of the plane
};

enum class ConstraintKind : std::uint8_t {
    boundary,  ///< f = 0 at a contour point
    normal,    ///< f = -offset at a contour point moved outward by the offset
    interior,  ///< f > 0 at a single point
    exterior,  ///< f < 0 at a single point
    bound,     ///< f kept within an interval
};

/// A constraint at a single point.
struct PointConstraint {
    Vec3 position;
    double value;
    ConstraintKind kind;
    double trust = 1;     ///< > 0: how closely f is to follow, against smoothness
    double noise_mm = 0;  ///< >= 0: standard deviation of the value
};

/// Where the implicit function is prescribed, and its value there. Values are in mm, so that |f| near the surface is about
/// the distance to it; with an offset of 1 mm they are the paper's 0 and -1.
struct ConstraintSet {
    std::vector<Vec3> centers;
    std::vector<double> values;
    std::vector<ConstraintKind> kinds;
    std::vector<double> trust;     ///< > 0, the smoothing of a constraint is divided by it; empty: all 1
    std::vector<double> noise_mm;  ///< >= 0, standard deviations of the values, beside smoothing; empty: all 0

    std::size_t size() const { return centers.size(); }
};

struct PlaceOptions {
    double normal_offset_mm = 1.0;  ///< length d > 0 of the normal constraints
    double merge_distance_mm = 0;   ///< a constraint closer than this to an earlier one is left out (0: only exact copies)
};

struct PlacedConstraints {
    ConstraintSet constraints;
    std::size_t merged = 0;  ///< constraints left out because they (nearly) repeat others
};

/// Throws Error(invalid_input) for an offset that is not above 0, a merge distance below 0, and either that is not finite.
void check_place_options(const PlaceOptions& options);
/// Throws Error(invalid_input) unless there is one slope in (0, 1] for each of the points.
void check_slopes(std::span<const double> slopes, std::size_t points);

/// Boundary constraints f = 0 at all points, and for each one normal constraint f = -d s at the distance d outside along
/// its in-plane normal; then the single points. The distance is the offset, but no more than half of the point's gap, so
/// that in a narrow cleft each wall keeps its side. `slopes` holds s in (0, 1], one per point: how fast f falls along the
/// in-plane normal, which for a distance-like f is the cosine of the surface's tilt against the contour's plane. All ones
/// is the paper's choice.
///
/// Near-duplicates make the system singular or contradictory (Turk & O'Brien 2002), so a constraint within the merge
/// distance of an earlier one is dropped; boundary constraints come first and win. Throws Error(invalid_input) as the two
/// checks do, for coordinates and values that are not finite, a gap that is not above 0, and a trust that is not finite and
/// above 0.
PlacedConstraints place_constraints(std::span<const BoundaryPoint> points, std::span<const double> slopes,
                                    std::span<const PointConstraint> single_points, const PlaceOptions& options = {});

}  // namespace kontur
