// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/shape/contour.h"

namespace kontur {

struct UnionOptions {
    double step_mm = 0.5;   ///< of the pixels on which the union is formed
    double spacing_mm = 0;  ///< least distance of an outline's points; 0: as they come, about a step apart
    double close_mm = 0;    ///< slivers between two structures that are as near as this belong to the union
};

/// Whether a contour of the set lies in a plane, within 0.02 mm.
bool is_drawn_in(const ContourSet& set, const Plane& plane);

/// The outlines of the union of structures, drawn by closed contours, in the planes that show all of them: each structure
/// either has contours in the plane or lies on one side of it. `hole` is set. Open contours, single points and planes that
/// show only some are left out; empty if nothing is left. Within about half of a step. Throws Error(too_large) for
/// planes of more than 2^28 pixels.
ContourSet union_contours(std::span<const ContourSet* const> structures, const UnionOptions& options = {});

/// The median distance of neighbouring points of what was drawn, in mm; 0 for single points.
double point_spacing_mm(std::span<const ContourSet* const> structures);

}  // namespace kontur
