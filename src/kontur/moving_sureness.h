// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/work.h"
#include "kontur/moving/moving_function.h"
#include "kontur/volume_curve.h"

namespace kontur {

/// Half the width in mm of the band in which 90 % of the true surface lies at a time, at points on or near the surface of
/// that time. At a moment it is that of its surface (surface_uncertainty.h), between two of them in between. It is wider by
/// how far the surface moves there from one to the other, and by how long that takes. Sections that were carried count as
/// drawn. Empty where a moment has too few planes to tell.
std::vector<double> half_widths_mm(const MovingFunction& function, const std::vector<DrawnMoment>& moments,
                                   const std::vector<Vec3>& points, double time, const Work& work = {});

}  // namespace kontur
