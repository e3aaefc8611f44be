// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"

namespace kontur {

/// Of each point of a lattice the nearest marked one.
struct DistanceTransform {
    std::vector<float> distances;        ///< to it, in units of the spacing; infinity without one
    std::vector<std::uint32_t> nearest;  ///< its offset, i fastest
};

/// Exact; of several as near one of them. `spacing`: of the points along i, j, k, > 0; the axes are taken as orthogonal. The
/// cost is the lattice's size (Felzenszwalb and Huttenlocher 2012). Of fewer than 2^32 points.
DistanceTransform distance_transform(const Index3& size, const Vec3& spacing, std::span<const std::uint8_t> marked,
                                     const Work& work = {});
/// The same in steps of a lattice whose steps are alike along its axes.
DistanceTransform distance_transform(const Index3& size, std::span<const std::uint8_t> marked);

}  // namespace kontur
