// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kontur/base/geometry.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"

namespace kontur::viewer {

/// What is measured of a structure. Lengths of the surface, values of the voxels whose centres lie inside.
struct Statistics {
    double volume_ml = 0;    ///< inside of the surface
    double surface_cm2 = 0;  ///< the surface's area
    double diameter_mm = 0;  ///< the largest distance of two of its points
    Vec3 from, to;           ///< these two
    Vec3 extent_mm;          ///< along the patient's axes
    std::int64_t voxels = 0;
    double mean = 0, deviation = 0;  ///< of the image's values; 0 without voxels. The deviation is that of all voxels (n)
    double least = 0, most = 0;
};

/// Throws Error(invalid_input) when image and mask have other grids.
Statistics statistics(const TriangleMesh& mesh, const Mask& mask, const Image& image);

}  // namespace kontur::viewer
