// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/shape/volume.h"

namespace kontur::viewer {

struct SnapOptions {
    double reach_mm = 0;     ///< how far the line may move; 0: twice as far as the planes lie apart
    double band_pixels = 4;  ///< how much of the image to both sides of the border is compared
    double stiffness = 0.3;  ///< against bends of the movement along the line
    double stay = 0.3;       ///< against movements, of the whole reach
};

/// A closed line and the plane that it lies in.
struct LineInPlane {
    const std::vector<Vec3>& points;
    const Plane& plane;
};

/// A closed line that is expected on a slice, moved along its normals to where the image beside it looks most as it does
/// beside the closed `drawn` line on a parallel plane nearby: which border it is that the user follows, bright against dark
/// or a thin rim, the drawn line tells. In mm; the line comes back as it was where it is shorter than 24 pixels, or where
/// the image is the same everywhere; `stay` keeps it where nothing fits clearly better.
std::vector<Vec3> snapped_line(const LineInPlane& line, const LineInPlane& drawn, const Image& image,
                               const SnapOptions& options = {});

}  // namespace kontur::viewer
