// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/bounds/bounds.h"
#include "kontur/bounds/drawn_regions.h"

namespace kontur {

/// How high the object goes on beyond a plane, and how much of that was read from distances between planes instead of
/// guessed from the outline's size.
struct EndHeight {
    double height_mm;
    double belief;
};

/// Between two answers, a geometric mean, since one may be many times the other. If planes were drawn one after another
/// across the whole object, the next one would have shown it, had it gone on so far: 0.85 of the mean of the gaps between
/// the parallel planes before it, from the nearest to the farthest, each believed by g / (g + g'), g' the gap before it. If
/// they show but a part of it, it is about as thick as wide: a radius of `guess_mm`, that of the circle with the outline's
/// area without its holes, less for the thickness t across which planes were drawn, guess^2 / (guess + 3/4 t).
/// The odds that they were drawn across all of it are (t / guess)^(4 / n) 2^(n (n - 1) / 2) with
/// n gaps, of which sum (g / widest g)^1.5 are counted: each pair of gaps that are alike doubles them. Planes tilted by up
/// to 20 degrees count less and less. No higher than 1.5 guesses, and a quarter higher than single points of the surface and
/// of the inside. Continuous in the planes' places.
EndHeight end_height(const DrawnPlanes& planes, const Section& section, double sign, double guess_mm);

/// The end of the object beyond a region on one side of its plane, in the direction of the normal times `sign`: a dome that
/// f is not to exceed, over each outline as high as end_height. It fades out where regions of other planes lie ahead of a
/// place in a cone of 45 degrees, unless they are specks, and altogether as contours of other directions lead on.
/// `is_guess` is set where the height is a guess from the section's width.
std::vector<Bound> end_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t region,
                              double sign, bool& is_guess);

}  // namespace kontur
