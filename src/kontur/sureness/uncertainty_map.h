// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/shape/volume.h"

namespace kontur {

struct SurfaceEvidence;

/// The band's half width in mm (half_widths_mm) at the voxels on both sides of the mask's border, in float; 0 elsewhere, and
/// everywhere where nothing is known of the surface's error. Where the image's border cuts the object off is no border.
Image uncertainty_map(const Mask& mask, const SurfaceEvidence& evidence, const Work& work = {});

}  // namespace kontur
