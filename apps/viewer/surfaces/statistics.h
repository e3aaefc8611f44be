// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kontur/base/geometry.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"

namespace kontur::viewer {

/// Of an image's values in the voxels whose centres lie inside.
struct ValueStatistics {
    std::int64_t voxels = 0;
    double mean = 0, deviation = 0;  ///< 0 without voxels. The deviation is that of all voxels (n)
    double least = 0, most = 0;
};

/// What is not finite is left out. Throws Error(invalid_input) when image and mask have other grids.
ValueStatistics value_statistics(const Mask& mask, const Image& image);

/// What is measured of a structure's surface.
struct Statistics {
    double volume_ml = 0;    ///< inside of the surface
    double surface_cm2 = 0;  ///< the surface's area
    double diameter_mm = 0;  ///< the largest distance of two of its points
    Vec3 from, to;           ///< these two
    Vec3 extent_mm;          ///< along the patient's axes
};

Statistics statistics(const TriangleMesh& mesh);

}  // namespace kontur::viewer
