// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/contour.h"

namespace kontur {

/// So many segments follow a round line as well as is needed.
inline constexpr int kLeastSegments = 48;

/// Subdivides long segments (paper section 5.2): a segment longer than twice the contour's average segment length gets
/// equally spaced points at about the average length. Where the average is longer than 1 / `least_segments` of the
/// perimeter, that length takes its place, so that a square drawn by its four corners stays a square. Drawn points stay.
/// Throws Error(invalid_input) for `least_segments` below 0.
Contour subdivide(const Contour& contour, int least_segments = 0);

}  // namespace kontur
