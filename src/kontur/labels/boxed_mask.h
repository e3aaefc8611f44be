// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/labels/label_boxes.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// An object in a grid: a mask on a box of it, beyond which there is nothing. Offsets are those of the whole grid.
struct BoxedMask {
    IndexBox box;
    Mask mask;  ///< on grid_of(the whole grid, box)

    bool contains(const Index3& at) const { return box.contains(at) && mask.values[place(at)]; }
    /// Of a voxel in the box.
    void set(const Index3& at, bool inside) { mask.values[place(at)] = inside; }

private:
    std::size_t place(const Index3& at) const {
        return mask.grid.offset(at.i - box.low.i, at.j - box.low.j, at.k - box.low.k);
    }
};

/// The same voxels on the smallest box around them; a single voxel, which is not set, if there are none.
BoxedMask trimmed(const BoxedMask& object, const Grid& grid);

/// The same voxels on a box of `grid` that contains the object's.
BoxedMask widened(const BoxedMask& object, const IndexBox& box, const Grid& grid);

/// The voxels that two objects share, in memory order.
std::vector<Index3> shared_voxels(const BoxedMask& a, const BoxedMask& b);

/// Whether a voxel of one object has a face in common with one of the other.
bool have_common_face(const BoxedMask& a, const BoxedMask& b);

}  // namespace kontur
