// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kontur/shape/contour.h"

namespace kontur {

struct TidyOptions {
    double spike_tolerance_mm = 0.001;  ///< a path that runs back along itself closer than this is a spike
    double thin_tolerance_mm = 0.01;    ///< dropped points may lie this far off what is kept ...
    std::size_t most_points = 1000;     ///< ... and farther, where a contour would keep more points than this otherwise
};

/// What was taken out of the contours.
struct TidyReport {
    std::size_t spike_points = 0;
    std::size_t thinned_contours = 0;
    std::size_t thinned_points = 0;
    double thinned_mm = 0;  ///< no thinned point lies farther than this from the polygon that was kept
};

/// Thins contours of more than four times `most_points` points, as `tidy` does: a line of 20,000 points on a hand's breadth
/// says what 400 of them say, and everything that is asked of a contour takes longer by as much. O(n log n).
TidyReport thin_vast(ContourSet& set, const TidyOptions& options = {});

/// Whether a contour is nothing but a path back along itself: `tidy` would leave nothing of it.
bool is_only_spikes(const Contour& contour, double spike_tolerance_mm);

/// Takes out what carries no shape: spikes, whose tip and way back enclose nothing, and the excess of contours with more
/// than `most_points` points. Thinning keeps the corners that Douglas and Peucker (1973) would; closed ones
/// begin then as begin_alike says, so that the same points are kept however they are stored. Shorter contours keep every
/// point. O(n log n) for n points of a drawn line, O(n^2) at worst. Throws Error(invalid_input), naming the contour, when
/// nothing is left of it.
TidyReport tidy(ContourSet& set, const TidyOptions& options = {});

}  // namespace kontur
