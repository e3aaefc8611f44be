// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/labels/painted_object.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// The mean over the slices of a voxel's largest distance from the outline; 0 without slices.
double half_thickness_mm(const PaintedObject& object);

/// The smoothing, on unit coordinates, of a fit to outlines painted on parallel slices. An outline is off the body between
/// the slices by what it shows of details that no other slice shows, and by the hand's wavering: by a twentieth of half the
/// thickness. (Chosen on structures kept for it, docs/fill.md.) What was painted stays as it is, so the fit need not pass
/// through it. Nothing where slices have several directions: these cross, and tell of each other.
std::optional<double> outline_smoothing(const PaintedObject& object, const ContourSet& contours);

}  // namespace kontur
