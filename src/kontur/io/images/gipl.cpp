// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/gipl.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "kontur/base/error.h"
#include "kontur/io/bytes/byte_order.h"
#include "kontur/io/images/voxel_stream.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHeaderBytes = 256;

/// Where the fields stand.
constexpr std::size_t kSizeAt = 0, kTypeAt = 8, kSpacingAt = 10, kOriginAt = 204, kOffsetAt = 236, kSlopeAt = 240,
                      kMagicAt = 252;
constexpr std::uint32_t kMagic = 0xEFFFE9B0, kOtherMagic = 0x2AE389B8;

using Header = std::array<unsigned char, kHeaderBytes>;

[[noreturn]] void fail(ErrorKind kind, const fs::path& path, const std::string& reason) {
    throw Error(kind, path.string() + ": " + reason);
}

VoxelType voxel_type(const Header& header, const fs::path& path) {
    switch (const auto type = load<std::uint16_t>(&header[kTypeAt], kBigEndian)) {
        case 1:
        case 8:
            return VoxelType::uint8;
        case 7:
            return VoxelType::int8;
        case 15:
            return VoxelType::int16;
        case 16:
            return VoxelType::uint16;
        case 31:
            return VoxelType::uint32;
        case 32:
            return VoxelType::int32;
        case 64:
            return VoxelType::float32;
        case 65:
            return VoxelType::float64;
        default:
            fail(ErrorKind::unsupported, path,
                 fmt::format("its samples are of type {}, which is not read; ITK-SNAP saves it as NIfTI", type));
    }
}

/// Programs differ on what these do to the samples, and most leave them 0.
void refuse_rescaling(const Header& header, const fs::path& path) {
    const double offset = load<float>(&header[kOffsetAt], kBigEndian), slope = load<float>(&header[kSlopeAt], kBigEndian);
    if (offset != 0 || (slope != 0 && slope != 1))
        fail(ErrorKind::unsupported, path,
             fmt::format("its samples are to be rescaled by {:g} and {:g}, which is not read; ITK-SNAP saves it as NIfTI",
                         slope, offset));
}

Grid grid_of(const Header& header, const fs::path& path) {
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<std::size_t>(axis);
        grid.size[axis] = load<std::uint16_t>(&header[kSizeAt + 2 * n], kBigEndian);
        Vec3 step;
        step[axis] = load<float>(&header[kSpacingAt + 4 * n], kBigEndian);
        if (!(step[axis] > 0))
            fail(ErrorKind::corrupt_file, path, fmt::format("its spacing along axis {} is {:g} mm", n + 1, step[axis]));
        grid.index_to_mm.set_column(axis, step);
        grid.index_to_mm.translation[axis] = load<double>(&header[kOriginAt + 8 * n], kBigEndian);
    }
    check_header_grid(grid, path);
    return grid;
}

OpenImage open_gipl(const fs::path& path, const ReadImageOptions& options) {
    InputFile file(path);
    if (file.at_gzip()) file.inflate();
    Header header{};
    file.read(header.data(), header.size());
    const auto magic = load<std::uint32_t>(&header[kMagicAt], kBigEndian);
    if (magic != kMagic && magic != kOtherMagic)
        fail(ErrorKind::corrupt_file, path, "it is no GIPL file (the last number of its header is wrong)");
    if (!options.allow_missing_geometry)
        fail(ErrorKind::unsupported, path,
             "GIPL does not say how it lies in the patient; the option allow_missing_geometry reads it along L, P, S");
    VoxelEncoding encoding;
    encoding.type = voxel_type(header, path);
    encoding.big_endian = kBigEndian;
    refuse_rescaling(header, path);
    const auto frames = load<std::uint16_t>(&header[kSizeAt + 6], kBigEndian);
    encoding.components = frames == 0 ? 1 : frames;  // what is written for images without a fourth axis
    OpenImage image{grid_of(header, path), encoding, std::move(file)};
    return image;
}

}  // namespace

Image read_gipl(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    return read_voxels(open_gipl(path, options), options, work);
}

Grid read_gipl_grid(const fs::path& path, const ReadImageOptions& options) { return open_gipl(path, options).grid; }

}  // namespace kontur
