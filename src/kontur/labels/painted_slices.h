// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kontur/shape/volume.h"

namespace kontur {

/// A slice of a grid on which an object was painted.
struct PaintedSlice {
    int axis = 2;            ///< of the grid, across the slice
    std::int64_t index = 0;  ///< along that axis
    bool whole = true;       ///< all that the mask has in this slice is its section: the rest of the slice lies outside
    std::vector<std::uint8_t> section{};  ///< 1 where it was painted; the first axis of the slice is fastest
};

/// The two axes of a slice across `axis`, in increasing order.
std::array<int, 2> slice_axes(int axis);

/// The slices of which a sparse mask is made: painted across one axis of the grid or across several, single ones or several
/// side by side, whole or in part. Sorted by axis and index.
///
/// A slice is short across and long within. Each voxel counts for the axis along which its run of painted voxels is
/// shortest. Slices are taken by the number of voxels that count for them and that no slice explains yet. A slice explains
/// what is connected with these in it, hardly farther away than its own thickness. So traces of slices in other directions
/// do not belong to its section. Within solids, three voxels thick along all axes, voxels count for the axis of most
/// others. (The interpolation of Zukic et al., 2016, asks each voxel alone whether its neighbours across are empty, and so
/// misses slices side by side.) Linear in the grid's voxels in time; one byte for each of them and two for each painted
/// one.
std::vector<PaintedSlice> find_painted_slices(const Mask& mask);

}  // namespace kontur
