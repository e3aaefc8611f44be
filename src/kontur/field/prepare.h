// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/field/caps.h"
#include "kontur/field/constraints.h"

namespace kontur {

struct PrepareOptions {
    double quality = 1.0;      ///< fraction of each contour's points to keep (reduce), in (0, 1]
    int least_segments = 48;   ///< contours of fewer segments, times quality, are subdivided (refine); 0: the paper's rule
    bool caps = true;          ///< limit the extrapolation beyond the last contours, and watch for leaks
    double copy_shift_mm = 0;  ///< > 0: coplanar contours get a copy of the first one, shifted by this (paper section 3.1)
};

/// The contours as the fit sees them.
struct PreparedContours {
    std::vector<BoundaryPoint> points;
    std::vector<Vec3> crossings;          ///< mm, where contours cross themselves
    std::vector<Vec3> between_crossings;  ///< mm, on edges of lobes that hold no point of a contour
    std::vector<Cap> caps;
    std::vector<Cap> leak_probes;
    bool coplanar = false;  ///< all contours lie in one plane, so they alone do not determine a surface
};

/// Reduces, refines and orients every contour. Contours in one plane leave f free across it and the system singular:
/// either the caps or the shifted copy must close the surface.
PreparedContours prepare(const ContourSet& set, const PrepareOptions& options = {});

}  // namespace kontur
