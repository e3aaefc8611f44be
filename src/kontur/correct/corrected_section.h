// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/correct/corrections.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/shape/section.h"

namespace kontur {

/// A line as a hand drew it, in a plane's (u, v), mm.
struct DrawnLine {
    Polygon2 points;
    bool closed = true;
    double weight = 1;
};

/// A plane with corrections: the object in it before and after.
struct CorrectedSection {
    Plane plane;
    Section before, after;
    std::vector<DrawnLine> lines{};  ///< where f is known to be 0: what was drawn, and the outline that was kept beside it
    bool redrawn = true;             ///< all of it; otherwise only pieces of outlines were replaced
    std::vector<std::size_t> contours{};  ///< of the drawing, that lie in it
    double moved_share = 1;               ///< of what its lines ask for that counts: 0 where they repeat the mask (kRepeats)
    double largest_move_mm = 0;           ///< of the mask's surface, along the lines; 0 where the plane was found right

    /// Whether anything moves in it: by more than `still_mm`, or a part more or less than before.
    bool moves(double still_mm) const;
};

/// Of the smallest voxel side: a line nearer to the mask's surface repeats it.
inline constexpr double kStillVoxels = 0.3;

/// Outlines drawn or traced anew differ from f0's by a part of a voxel. Where a whole outline lies nowhere farther from the
/// mask's surface than kRepeats of the largest voxel side along its plane, it repeats the mask and carries nothing on; at
/// one and a half times that all of it counts. In its plane it may lie kMovedInPlane times as far: where the plane runs
/// along the surface.
inline constexpr double kRepeats = 0.6;

/// By plane, in the order of the first contour of each, then empty and confirmed ones. Outlines of the mask are found on a
/// lattice of `step_mm`. Throws Error(invalid_input), naming the contour (counted from 1): what contour_problem says, and
/// for an open contour that cannot replace a piece of an outline.
std::vector<CorrectedSection> corrected_sections(const ExistingSurface& surface, const Corrections& corrections,
                                                 double step_mm);

}  // namespace kontur
