// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kontur/shape/index_box.h"
#include "kontur/shape/volume.h"

namespace kontur::viewer {

/// A mask that a structure's contours correct, as it came in, in few bytes: the voxels of the box around those inside. All
/// others lie outside. Immutable.
class StoredMask {
public:
    /// Throws Error(invalid_input) for a mask without a voxel inside, and as check_mask does.
    explicit StoredMask(const Mask& mask);
    /// As `header()` and `packed()` were. Throws Error(invalid_input) where they contradict each other, or are damaged.
    StoredMask(std::string_view header, std::string packed);

    /// SHA-256 of all that it says: two equal masks have one name.
    const std::string& hash() const { return hash_; }
    const Grid& grid() const { return grid_; }
    const IndexBox& box() const { return box_; }
    /// Grid and box as JSON.
    std::string header() const;
    /// The box's voxels, eight to a byte, as a zlib stream.
    const std::string& packed() const { return packed_; }

    /// The whole mask, as large as its grid. Byte for byte what came in.
    Mask mask() const;
    /// Whether both have a voxel in common; of one grid.
    bool meets(const StoredMask& other) const;

private:
    friend class MaskVoxels;

    std::string unpacked() const;
    std::string digest(std::string_view bits) const;

    Grid grid_;
    IndexBox box_;
    std::string packed_, hash_;
};

/// Looks voxels of a mask up, in an eighth of its box's bytes. The mask has to live as long.
class MaskVoxels {
public:
    explicit MaskVoxels(const StoredMask& mask) : mask_(mask), bits_(mask.unpacked()) {}

    /// `offset`: in the mask's grid.
    bool contains(std::size_t offset) const;

private:
    const StoredMask& mask_;
    std::string bits_;
};

}  // namespace kontur::viewer
