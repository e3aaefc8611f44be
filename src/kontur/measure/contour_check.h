// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

enum class Severity {
    note,     ///< worth knowing
    warning,  ///< probably not meant so; the result may not be what was meant
    error,    ///< the set cannot be segmented
};
std::string_view name(Severity severity) noexcept;

enum class FindingKind {
    no_contours,
    too_few_points,   ///< fewer than 3 different ones (open contours: 2)
    not_finite,       ///< a coordinate is NaN or infinite
    off_plane,        ///< a point lies too far off its contour's plane
    no_area,          ///< all points lie on one line: an error only where no other contour shows the object
    unusable,         ///< refused by `check_contours` for another reason, such as a hole that is open
    repeated_points,  ///< edges of length zero
    spike,            ///< the path turns and runs back on itself
    self_crossing,
    self_touch,
    long_edge,        ///< far longer than the contour's others
    maybe_open,       ///< closed, but between its last and its first point lies a gap
    maybe_closed,     ///< open, but its ends nearly meet
    tiny,             ///< small beside the whole set
    duplicate,        ///< the same outline twice in one plane, or two that count as one (apply_fill_rule)
    overlap,          ///< two outlines of one plane cross each other
    unmarked_hole,    ///< inside of another contour of its plane, not marked: with FillRule::even_odd it is a hole
    thin_wall,        ///< the same, between which and the contour around it little is left: perhaps one line, drawn twice
    stray_hole,       ///< a hole that no contour surrounds
    contradiction,    ///< contours of different planes disagree where they meet
    misplaced_point,  ///< an interior or exterior point on the wrong side of the contours drawn in its plane
    isolated,         ///< no other contour tells how the object goes on from this one
    gap,              ///< a missing slice
    far_rings,        ///< sections of a tube that are far apart for their width
    one_plane,        ///< all contours lie in one plane
    implausible_size,
    far_away,
};
std::string_view name(FindingKind kind) noexcept;

/// One thing that is wrong or doubtful in a contour set.
struct Finding {
    FindingKind kind;
    Severity severity;
    std::string text;                      ///< one sentence with the numbers; contours are counted from 1
    std::optional<std::size_t> contour{};  ///< index
    std::optional<std::size_t> other{};    ///< index of a second one that takes part
    std::optional<Vec3> position{};        ///< mm, where to look
    std::optional<double> value_mm{};      ///< the length that the sentence is about
};

struct ContourSetCheckOptions {
    ContourCheckOptions limits;  ///< of what counts as an error
    std::optional<double>
        disagreement_mm;  ///< contours of different planes may disagree so much; unset: 1.5 % of the contours' diameter
};

/// Everything that is wrong or doubtful, errors first; at most one finding of a kind for each contour or pair of contours,
/// with the worst place. There is an error exactly when `check_contours` would refuse the set without its repeated points.
/// O(n log n) for n points, and quadratic in the contours and points of a plane.
std::vector<Finding> check_contour_set(const ContourSet& set, const ContourSetCheckOptions& options = {});

}  // namespace kontur
