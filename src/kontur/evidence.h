// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/segment.h"
#include "kontur/sureness/surface_evidence.h"

namespace kontur {

/// What is known of a surface from the `contours` that it was made from.
SurfaceEvidence gather_evidence(const Segmentation& segmentation, const ContourSet& contours, const Work& work = {});

}  // namespace kontur
