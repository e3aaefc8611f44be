// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/mgh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/byte_order.h"
#include "kontur/io/bytes/deflate.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/geometry/affine_frame.h"
#include "kontur/io/images/voxel_stream.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHeaderBytes = 284;
constexpr std::size_t kScanBytes =
    20;  ///< behind the voxels: repetition, echo and inversion time, flip angle, field of view
constexpr std::int32_t kCommandTag = 3;  ///< TAG_CMDLINE
constexpr std::string_view kBegin = "kontur\n";

/// Where the fields stand.
constexpr std::size_t kVersionAt = 0, kSizeAt = 4, kFramesAt = 16, kTypeAt = 20, kGoodRasAt = 28, kSpacingAt = 30,
                      kDirectionsAt = 42, kCentreAt = 78;

using Header = std::array<unsigned char, kHeaderBytes>;

[[noreturn]] void fail(ErrorKind kind, const fs::path& path, const std::string& reason) {
    throw Error(kind, path.string() + ": " + reason);
}

std::int32_t integer_at(const Header& header, std::size_t at) { return load<std::int32_t>(&header[at], kBigEndian); }
double real_at(const Header& header, std::size_t at) { return load<float>(&header[at], kBigEndian); }
Vec3 vector_at(const Header& header, std::size_t at) {
    return {real_at(header, at), real_at(header, at + 4), real_at(header, at + 8)};
}

VoxelType voxel_type(const Header& header, const fs::path& path) {
    switch (const std::int32_t type = integer_at(header, kTypeAt)) {
        case 0:
            return VoxelType::uint8;
        case 1:
            return VoxelType::int32;
        case 3:
            return VoxelType::float32;
        case 4:
            return VoxelType::int16;
        case 10:
            return VoxelType::uint16;
        default:
            fail(ErrorKind::unsupported, path,
                 fmt::format("its samples are of type {}, which is not read; 0, 1, 3, 4 and 10 are", type));
    }
}

/// The middle of the volume as FreeSurfer takes it: half of each size, in voxels.
Vec3 middle(const Index3& size) {
    return 0.5 * Vec3{static_cast<double>(size.i), static_cast<double>(size.j), static_cast<double>(size.k)};
}

Affine3 index_to_ras(const Header& header, const Index3& size, const fs::path& path, const ReadImageOptions& options) {
    const bool is_known = load<std::int16_t>(&header[kGoodRasAt], kBigEndian) > 0;
    if (!is_known && !options.allow_missing_geometry)
        fail(ErrorKind::unsupported, path,
             "it does not say how it lies in the patient (goodRASFlag is 0); the option allow_missing_geometry reads it as "
             "FreeSurfer does, as coronal slices with 1 mm");
    constexpr std::array<Vec3, 3> kCoronal{Vec3{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    Affine3 affine;
    for (int axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<std::size_t>(axis);
        affine.set_column(
            axis, is_known ? real_at(header, kSpacingAt + 4 * n) * vector_at(header, kDirectionsAt + 12 * n) : kCoronal[n]);
    }
    const Vec3 centre = is_known ? vector_at(header, kCentreAt) : Vec3{};
    affine.translation = centre - affine.apply_linear(middle(size));
    return affine;
}

Header read_header(InputFile& file) {
    if (file.at_gzip()) file.inflate();
    Header header{};
    file.read(header.data(), header.size());
    if (const std::int32_t version = integer_at(header, kVersionAt); version != 1)
        fail(ErrorKind::corrupt_file, file.path(),
             fmt::format("it is no MGH file of version 1 (its first number is {})", version));
    return header;
}

OpenImage open_mgh(const fs::path& path, const ReadImageOptions& options) {
    InputFile file(path);
    const Header header = read_header(file);
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) grid.size[axis] = integer_at(header, kSizeAt + 4 * static_cast<std::size_t>(axis));
    VoxelEncoding encoding;
    encoding.type = voxel_type(header, path);
    encoding.big_endian = kBigEndian;
    encoding.components = integer_at(header, kFramesAt);
    if (encoding.components < 1)
        fail(ErrorKind::corrupt_file, path, fmt::format("it declares {} frames", encoding.components));
    grid.index_to_mm = ras_to_lps(index_to_ras(header, grid.size, path, options));
    check_header_grid(grid, path);
    return {grid, encoding, std::move(file)};
}

/// The sample type in the file of one in memory.
template <typename Value>
using StoredAs = std::conditional_t<std::is_same_v<Value, std::uint16_t>, std::int32_t, Value>;

template <typename FileValue>
constexpr std::int32_t type_code() {
    if constexpr (std::is_same_v<FileValue, std::uint8_t>) return 0;
    else if constexpr (std::is_same_v<FileValue, std::int32_t>) return 1;
    else if constexpr (std::is_same_v<FileValue, float>) return 3;
    else return 4;
}

void put_vector(const Vec3& v, Header& header, std::size_t at) {
    for (int axis = 0; axis < 3; ++axis)
        store(static_cast<float>(v[axis]), kBigEndian, &header[at + 4 * static_cast<std::size_t>(axis)]);
}

Header header_for(const ImageView& image) {
    Header header{};
    const Index3& size = image.grid.size;
    const Affine3 affine = lps_to_ras(image.grid.index_to_mm);
    store<std::int32_t>(1, kBigEndian, &header[kVersionAt]);
    for (int axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<std::size_t>(axis);
        const Vec3 column = affine.column(axis);
        store(static_cast<std::int32_t>(size[axis]), kBigEndian, &header[kSizeAt + 4 * n]);
        store(static_cast<float>(norm(column)), kBigEndian, &header[kSpacingAt + 4 * n]);
        put_vector(normalized(column), header, kDirectionsAt + 12 * n);
    }
    put_vector(affine.apply(middle(size)), header, kCentreAt);
    store<std::int32_t>(1, kBigEndian, &header[kFramesAt]);
    store<std::int16_t>(1, kBigEndian, &header[kGoodRasAt]);
    std::visit(
        [&]<typename Value>(std::span<const Value>) { store(type_code<StoredAs<Value>>(), kBigEndian, &header[kTypeAt]); },
        image.samples);
    return header;
}

/// `put(bytes)` for all samples, a piece at a time.
template <typename Put>
void put_samples(const ImageView& image, const Put& put) {
    constexpr std::size_t kChunk = std::size_t{1} << 16;
    std::visit(
        [&]<typename Value>(std::span<const Value> values) {
            using FileValue = StoredAs<Value>;
            std::vector<unsigned char> bytes;
            for (std::size_t begin = 0; begin < values.size(); begin += kChunk) {
                const auto chunk = values.subspan(begin, std::min(kChunk, values.size() - begin));
                bytes.resize(chunk.size() * sizeof(FileValue));
                for (std::size_t n = 0; n < chunk.size(); ++n)
                    store(static_cast<FileValue>(chunk[n]), kBigEndian, &bytes[n * sizeof(FileValue)]);
                put(std::as_bytes(std::span(bytes)));
            }
        },
        image.samples);
}

/// What stands behind the voxels; nothing without provenance.
std::vector<unsigned char> footer(const Provenance& provenance) {
    if (provenance.empty()) return {};
    std::string text(kBegin);
    for (const auto& [name, value] : provenance) text += fmt::format("{}: {}\n", name, value);
    text += '\0';
    std::vector<unsigned char> bytes(kScanBytes + 12);
    store(kCommandTag, kBigEndian, &bytes[kScanBytes]);
    store(static_cast<std::int64_t>(text.size()), kBigEndian, &bytes[kScanBytes + 4]);
    bytes.insert(bytes.end(), text.begin(), text.end());
    return bytes;
}

/// The text of kontur's tag, at which the file stands if it has one; "" for none.
std::string read_command(InputFile& file) {
    constexpr std::int64_t kMostBytes = 1 << 16;
    std::array<unsigned char, kScanBytes + 12> start{};
    if (file.read_some(start.data(), start.size()) < start.size()) return {};
    const auto length = load<std::int64_t>(&start[kScanBytes + 4], kBigEndian);
    if (load<std::int32_t>(&start[kScanBytes], kBigEndian) != kCommandTag || length < 1 || length > kMostBytes) return {};
    std::string text(static_cast<std::size_t>(length), '\0');
    text.resize(file.read_some(text.data(), text.size()));
    return text.substr(0, text.find('\0'));
}

}  // namespace

Image read_mgh(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    return read_voxels(open_mgh(path, options), options, work);
}

Grid read_mgh_grid(const fs::path& path, const ReadImageOptions& options) { return open_mgh(path, options).grid; }

Provenance read_mgh_provenance(const fs::path& path) {
    ReadImageOptions options;
    options.allow_missing_geometry = true;
    OpenImage image = open_mgh(path, options);
    const std::uint64_t bytes = declared_bytes(image);
    image.data.expect(bytes);
    image.data.skip(bytes);
    const std::string text = read_command(image.data);
    Provenance found;
    if (!text.starts_with(kBegin)) return found;
    for (std::string_view left = std::string_view(text).substr(kBegin.size()); !left.empty();) {
        const std::string_view line = left.substr(0, left.find('\n'));
        left.remove_prefix(std::min(line.size() + 1, left.size()));
        if (const std::size_t colon = line.find(": "); colon != std::string_view::npos)
            found.emplace_back(line.substr(0, colon), line.substr(colon + 2));
    }
    return found;
}

void write_mgh(const fs::path& path, const ImageView& image) {
    check_grid(image.grid);
    const Index3& size = image.grid.size;
    if (std::max({size.i, size.j, size.k}) > std::numeric_limits<std::int32_t>::max())
        fail(ErrorKind::too_large, path, fmt::format("{} x {} x {} voxels; MGH counts by 32 bits", size.i, size.j, size.k));
    const Header header = header_for(image);
    const std::vector<unsigned char> behind = footer(image.provenance);
    const auto put_all = [&](const auto& put) {
        put(std::as_bytes(std::span(header)));
        put_samples(image, put);
        put(std::as_bytes(std::span(behind)));
    };
    write_file_atomically(path, [&](AtomicFile& file) {
        if (lower_case(path.extension().string()) == ".mgh")
            return put_all([&](std::span<const std::byte> bytes) { file.write(bytes.data(), bytes.size()); });
        Deflater deflater(
            DeflateFormat::gzip, [&](const void* data, std::size_t count) { file.write(data, count); }, deflate_mode(image));
        put_all([&](std::span<const std::byte> bytes) { deflater.write(bytes); });
        deflater.finish();
    });
}

}  // namespace kontur
