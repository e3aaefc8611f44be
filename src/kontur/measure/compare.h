// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "kontur/base/work.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Distances in mm between the surfaces of two masks. A surface is the set of centres of the inside voxels that have an
/// outside face neighbour; beyond the grid all is outside. From each surface voxel of one mask the distance to the
/// nearest surface voxel of the other is taken, in both directions.
struct SurfaceDistance {
    double hausdorff_mm = 0;              ///< the largest of all
    double hausdorff95_mm = 0;            ///< the 95th percentile of each direction (linear between ranks), the larger one
    double mean_surface_distance_mm = 0;  ///< the mean over both directions together
};

/// How two masks of one grid agree.
struct Comparison {
    double volume_a_ml = 0;
    double volume_b_ml = 0;
    double dice = 0;                         ///< 2 |A and B| / (|A| + |B|); 1 when both are empty
    double jaccard = 0;                      ///< |A and B| / |A or B|; 1 when both are empty
    std::optional<SurfaceDistance> surface;  ///< absent when a mask is empty
};

/// Values other than 0 are inside; distances are measured on `a`'s grid. Exact on anisotropic, oblique and sheared grids.
/// Throws Error(invalid_input), saying how they differ, when the grids differ in size or by more than 0.001 mm at a corner.
Comparison compare(const Mask& a, const Mask& b, const Work& work = {});

}  // namespace kontur
