// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/contour.h"

namespace kontur {

struct ReduceOptions {
    double quality = 1.0;        ///< fraction q of the points to keep, in (0, 1]; 1 keeps all
    std::size_t min_points = 6;  ///< a contour is never reduced below this many points
};

void check_quality(double quality);

/// Removes the points that matter least for a contour's shape (paper section 4.3, after Latecki & Lakaemper 1999): weight
/// = (1 - cos of the turning angle) / 2 * |a||b| / (|a| + |b|) for the adjacent edges a and b; the point of lowest weight
/// goes, its neighbours' weights are updated, until ceil(q * original) points are left. The ends of an open contour stay.
/// O(m log m) for m points.
/// Throws Error(invalid_input) for a quality outside (0, 1] (check_quality), and fewer than 2 points at least.
Contour reduce(const Contour& contour, const ReduceOptions& options = {});

}  // namespace kontur
