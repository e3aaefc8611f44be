// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/field/fit.h"
#include "kontur/field/reconcile.h"
#include "kontur/segment.h"

namespace kontur {

/// The options of `segment` spelled out for its first stages.
struct Fitting {
    PrepareOptions prepare;
    ReconcileOptions reconcile;
    FitOptions fit;
};

/// Lengths that are not given follow the contours' size. Throws Error(invalid_input) when the normal offset is not above 0.
Fitting fitting_for(const ContourSet& contours, const SegmentOptions& options);

/// The contours as the fit sees them, reconciled where they contradict each other.
PreparedContours prepare(const ContourSet& contours, const Fitting& fitting);

/// Where the surface is known to pass: every drawn point and point of the fit, each edge of each lobe where contours cross
/// themselves, and a place near each exterior point that only just got its side: it may have made a cavity. Not near
/// interior points: beside the contours nothing bounds what they make.
std::vector<Vec3> start_points(const ContourSet& contours, const PreparedContours& prepared,
                               const ImplicitFunction& function, double click_margin_mm);

}  // namespace kontur
