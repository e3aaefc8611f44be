// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/drawing/bounds.h"
#include "kontur/drawing/drawn_regions.h"

namespace kontur {

/// How high the object goes on beyond a plane, and how much of that was read from distances between planes instead of
/// guessed from the section's width.
struct EndHeight {
    double height_mm;
    double belief;
};

/// About as far as the parallel planes before it are apart: the mean of their gaps, from the nearest to the farthest, each
/// believed by g / (g + g'), g' the gap before it or, for the first one, the radius of the largest inscribed circle, which
/// is also what is left of a guess. Planes tilted by 6 to 30 degrees count less and less. No higher than 1.5 of these radii,
/// and a quarter higher than single points of the surface and of the inside. Continuous in the planes' places.
EndHeight end_height(const DrawnPlanes& planes, const Section& section, double sign, double inscribed_radius);

/// The end of the object beyond a region on one side of its plane, in the direction of the normal times `sign`: a dome that
/// f is not to exceed, over each outline as high as end_height. It fades out where regions of other planes lie ahead of a
/// place in a cone of 45 degrees, and altogether as contours of other directions lead on.
/// `is_guess` is set where the height is a guess from the section's width.
std::vector<Bound> end_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t region,
                              double sign, bool& is_guess);

}  // namespace kontur
