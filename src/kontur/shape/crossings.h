// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// A place where a contour passes through the plane of another one. Both planes show the object along their common line, so
/// contours that agree pass it at the same points.
struct Crossing {
    std::size_t contour = 0;     ///< index of the contour that passes through the plane of ...
    std::size_t other = 0;       ///< ... this one
    Vec3 position;               ///< mm, where `contour` passes the line
    Vec3 other_position;         ///< mm, where `other` passes it; unmatched: the nearest point of `other` in its plane
    bool matched = false;        ///< false: `contour` shows the object begin or end where the other plane shows nothing
    double distance_mm = 0;      ///< between the two positions; > 0 where `contour` passes outside of `other`, else < 0
    double disagreement_mm = 0;  ///< >= 0, how far a surface would have to move so that both are right
};

/// Every place where closed contours of different planes meet. On the line that two planes share, entries into the object
/// and exits are matched in order, such that the lengths of contradiction are least. Matched pairs appear once, the contour
/// of the lower index first. A gap, a tip that just reaches through the plane, or a second object that only one plane shows
/// stays unmatched.
///
/// A line that cuts a surface at a flat angle makes much of a small displacement. So the disagreement of a match is the
/// lesser distance of either position from the other plane's contours; unmatched it is at most half the length that is shown
/// or missing on the line, and the depth to which the contour reaches through the plane.
///
/// Planes less than half a degree apart count as parallel. Open contours and those of fewer than 3 points are left out.
/// O(points * planes).
std::vector<Crossing> find_crossings(const ContourSet& set);

/// "contour 3 passes 4.2 mm inside of contour 7 at (1.0, 2.0, 3.0) mm", contours counted from 1;
/// the number is the disagreement.
std::string sentence(const Crossing& crossing);

/// How well contours agree where they cross, over matched crossings.
struct Disagreement {
    std::size_t matched = 0;
    std::size_t unmatched = 0;
    double mean_mm = 0;
    double rms_mm = 0;
    double max_mm = 0;
    double max_unmatched_mm = 0;  ///< largest disagreement of those that are not matched
};

Disagreement disagreement(std::span<const Crossing> crossings);

/// The same for each of `contour_count` contours, over the crossings that it takes part in.
std::vector<Disagreement> disagreement_by_contour(std::span<const Crossing> crossings, std::size_t contour_count);

}  // namespace kontur
