// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Where one of two masks is, and the other is not.
struct Difference {
    Vec3 at;                 ///< the centre of the voxel that lies farthest from the other mask, mm
    double distance_mm = 0;  ///< of that voxel from the other mask's nearest one, centre to centre
    double volume_ml = 0;
    bool in_first = false;  ///< it is the first mask that has it
};

/// Two bulges of one connected piece are two differences where the way from one to the other comes nearer to the other mask
/// than this share of the lower one's height. Half as much tells few bulges on a thick layer apart, 1 each voxel that lies
/// farther off than its neighbours.
inline constexpr double kSaddle = 0.5;

/// The places where two masks of one grid differ, the farthest first, of equal ones the larger. Together they are all
/// voxels that one mask alone has. None where a mask is empty: there is nothing then that the other could lie away from.
/// Throws Error(invalid_input) as `compare`, and for a saddle out of (0, 1]. Exact on anisotropic, oblique and sheared
/// grids; the same for any number of threads.
std::vector<Difference> differences(const Mask& a, const Mask& b, double saddle = kSaddle, const Work& work = {});

}  // namespace kontur
