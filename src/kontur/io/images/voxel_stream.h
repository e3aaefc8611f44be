// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "kontur/base/work.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/images/read_image_options.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Sample types on disk. Internal to io, as is the rest of this file.
enum class VoxelType { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 };

std::size_t byte_size(VoxelType type) noexcept;

/// How a file stores its samples.
struct VoxelEncoding {
    VoxelType type = VoxelType::uint8;
    bool big_endian = false;
    bool text = false;            ///< decimal numbers between blanks
    std::int64_t components = 1;  ///< frames, layers or channels for each voxel
    bool interleaved = false;     ///< true: all components of a voxel stand together; false: one volume after the other
    double slope = 1, intercept = 0;
};

/// An image file whose header has been read: the formats differ only up to here.
struct OpenImage {
    Grid grid;
    VoxelEncoding encoding;
    InputFile data;  ///< at the first byte of the voxels
};

/// Bytes of all voxels as declared (for text: the least they can take). Throws Error(corrupt_file) beyond 64 bits.
std::uint64_t declared_bytes(const OpenImage& image);

/// Tells of bytes behind the voxels, which are not compressed: the header may declare fewer slices or frames than there are.
void note_bytes_left(const OpenImage& image, const ReadImageOptions& options);

/// The component that the options choose, in the narrowest sample type that is exact. Checks the declared size against the
/// file and against `max_voxels` before it allocates.
Image read_voxels(OpenImage&& image, const ReadImageOptions& options, const Work& work = {});

/// Throws Error(corrupt_file) naming the file for a size below 1, more voxels than 64 bits index, dependent or NaN axes.
void check_header_grid(const Grid& grid, const std::filesystem::path& path);

}  // namespace kontur
