// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kontur/labels/boxed_mask.h"

namespace kontur {

/// Voxels that belong to the same objects, counted from 0: those that belong to none.
using Region = std::uint32_t;

/// The regions of all voxels of a box around the objects, one voxel wider, which may lie beyond the grid.
class RegionMap {
public:
    explicit RegionMap(std::span<const BoxedMask> objects);

    const IndexBox& box() const { return box_; }
    const std::vector<std::vector<std::size_t>>& regions() const { return regions_; }
    Region at(const Index3& voxel) const { return of_voxels_[place(voxel)]; }
    bool is_member(Region region, std::size_t object) const {
        return std::binary_search(regions_[region].begin(), regions_[region].end(), object);
    }

private:
    std::size_t place(const Index3& voxel) const {
        const Index3 size = box_.size();
        return static_cast<std::size_t>(voxel.i - box_.low.i +
                                        size.i * (voxel.j - box_.low.j + size.j * (voxel.k - box_.low.k)));
    }

    void add(const BoxedMask& mask, std::size_t object);

    IndexBox box_;
    std::vector<std::vector<std::size_t>> regions_;
    std::vector<Region> of_voxels_;
};

}  // namespace kontur
