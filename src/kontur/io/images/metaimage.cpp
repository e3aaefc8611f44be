// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/metaimage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "kontur/base/printable.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/deflate.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/images/voxel_stream.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxLineBytes = std::size_t{1} << 16;
constexpr std::size_t kMaxLines = 10000;
constexpr std::size_t kMaxCommentBytes = 200;  ///< MetaIO's own reader has room for 255

/// MetaIO has several names for some fields.
std::string canonical_key(std::string_view key) {
    static const std::map<std::string, std::string, std::less<>> kSynonyms{
        {"Position", "Offset"},
        {"Origin", "Offset"},
        {"Orientation", "TransformMatrix"},
        {"Rotation", "TransformMatrix"},
        {"ElementByteOrderMSB", "BinaryDataByteOrderMSB"}};
    const auto found = kSynonyms.find(key);
    return found == kSynonyms.end() ? std::string(key) : found->second;
}

/// Reads up to and including "ElementDataFile", which ends the header.
TextHeader read_header(InputFile& file) {
    TextHeader header(file.path());
    for (std::size_t number = 0; number < kMaxLines; ++number) {
        const auto line = file.read_line(kMaxLineBytes);
        if (!line) header.refuse(ErrorKind::corrupt_file, "it ends within its header");
        if (trimmed(*line).empty()) continue;
        const std::size_t equals = line->find('=');
        if (equals == std::string::npos)
            header.refuse(ErrorKind::corrupt_file,
                          fmt::format("its header line \"{}\" has no equals sign", line->substr(0, 40)));
        const std::string key = canonical_key(trimmed(std::string_view(*line).substr(0, equals)));
        header.add(key, std::string_view(*line).substr(equals + 1));
        if (key == "ElementDataFile") return header;
    }
    header.refuse(ErrorKind::corrupt_file, fmt::format("no ElementDataFile is among its first {} lines", kMaxLines));
}

bool flag(const TextHeader& header, const std::string& key, bool fallback) {
    const std::string text = lower_case(header.find(key).value_or(fallback ? "true" : "false"));
    if (text == "true" || text == "1") return true;
    if (text == "false" || text == "0") return false;
    header.refuse(ErrorKind::corrupt_file, fmt::format("its field \"{}\" is \"{}\"; True or False is expected", key, text));
}

VoxelType voxel_type(const TextHeader& header) {
    static const std::map<std::string, VoxelType, std::less<>> kTypes{
        {"MET_CHAR", VoxelType::int8},         {"MET_UCHAR", VoxelType::uint8},   {"MET_SHORT", VoxelType::int16},
        {"MET_USHORT", VoxelType::uint16},     {"MET_INT", VoxelType::int32},     {"MET_UINT", VoxelType::uint32},
        {"MET_LONG", VoxelType::int32},        {"MET_ULONG", VoxelType::uint32},  {"MET_LONG_LONG", VoxelType::int64},
        {"MET_ULONG_LONG", VoxelType::uint64}, {"MET_FLOAT", VoxelType::float32}, {"MET_DOUBLE", VoxelType::float64},
    };
    const std::string name = header.text("ElementType");
    const auto found = kTypes.find(name);
    if (found == kTypes.end()) header.refuse(ErrorKind::unsupported, fmt::format("its ElementType {} is not read", name));
    return found->second;
}

/// Lengths of a step along each axis; MetaIO lets the voxel's size stand for it.
std::vector<double> spacing(const TextHeader& header, std::size_t axes, const ReadImageOptions& options) {
    for (const char* key : {"ElementSpacing", "ElementSize"})
        if (header.has(key)) return header.numbers(key, axes);
    if (!options.allow_missing_geometry)
        header.refuse(ErrorKind::unsupported,
                      "it states no ElementSpacing; the option allow_missing_geometry reads it with 1 mm");
    return std::vector<double>(axes, 1.0);
}

std::vector<double> identity_matrix(std::size_t axes) {
    std::vector<double> matrix(axes * axes, 0.0);
    for (std::size_t axis = 0; axis < axes; ++axis) matrix[axis * axes + axis] = 1;
    return matrix;
}

/// Of a file with a fourth axis, time, only the part in space.
Affine3 index_to_mm(const TextHeader& header, std::size_t axes, const ReadImageOptions& options) {
    const auto steps = spacing(header, axes, options);
    const auto matrix =
        header.has("TransformMatrix") ? header.numbers("TransformMatrix", axes * axes) : identity_matrix(axes);
    const auto offset = header.has("Offset") ? header.numbers("Offset", axes) : std::vector<double>(axes, 0.0);
    Affine3 affine;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto direction = std::span(matrix).subspan(axis * axes, axes);
        affine.set_column(static_cast<int>(axis), steps[axis] * Vec3{direction[0], direction[1], direction[2]});
        if (axes == 4 && direction[3] != 0)
            header.refuse(ErrorKind::unsupported, "its TransformMatrix mixes space with the fourth axis");
    }
    affine.translation = {offset[0], offset[1], offset[2]};
    return affine;
}

/// MetaIO's own readers disagree on whether these apply to the samples that they deliver.
void refuse_intensity_function(const TextHeader& header) {
    for (const auto& [key, neutral] :
         {std::pair{"ElementToIntensityFunctionSlope", 1.0}, {"ElementToIntensityFunctionOffset", 0.0}})
        if (header.has(key) && header.numbers(key, 1)[0] != neutral)
            header.refuse(
                ErrorKind::unsupported,
                fmt::format("its {} is {}; rescaled samples are not read; save it with the values that they mean first", key,
                            header.text(key)));
}

std::int64_t component_count(const TextHeader& header, const std::vector<std::int64_t>& sizes, bool& interleaved) {
    const std::int64_t channels =
        header.has("ElementNumberOfChannels") ? header.integers("ElementNumberOfChannels", 1)[0] : 1;
    const std::int64_t frames = sizes.size() == 4 ? sizes[3] : 1;
    if (channels < 1 || frames < 1)
        header.refuse(ErrorKind::corrupt_file, fmt::format("it declares {} channels and {} frames", channels, frames));
    if (channels > 1 && frames > 1)
        header.refuse(ErrorKind::unsupported,
                      fmt::format("it has {} channels in each of {} frames; save a single channel first", channels, frames));
    interleaved = channels > 1;
    return std::max(channels, frames);
}

bool is_local(const std::string& name) { return lower_case(name) == "local"; }
bool is_list(const std::string& name) { return name.starts_with("LIST") || name.find('%') != std::string::npos; }

InputFile data_file(InputFile&& header_file, const TextHeader& header) {
    const std::string name = header.text("ElementDataFile");
    if (is_local(name)) return std::move(header_file);
    if (is_list(name))
        header.refuse(ErrorKind::unsupported,
                      "its voxels are in several files, which is not read; save it as one first, with 3D Slicer say");
    // What is left of "LOCAL" in a file that was cut off is a name, too.
    std::error_code ignored;
    if (const fs::path voxels = path_beside(header.path(), name);
        lower_case(header.path().extension().string()) == ".mha" && !fs::exists(voxels, ignored))
        header.refuse(ErrorKind::corrupt_file, fmt::format("its voxels are in \"{}\", which is not there", name));
    return open_beside(header.path(), name);
}

void advance_to_voxels(OpenImage& image, const TextHeader& header, const ReadImageOptions& options) {
    const std::int64_t skipped = header.has("HeaderSize") ? header.integers("HeaderSize", 1)[0] : 0;
    const bool compressed = flag(header, "CompressedData", false);
    if (skipped < -1 || (skipped == -1 && (compressed || image.encoding.text)))
        header.refuse(ErrorKind::corrupt_file, fmt::format("its HeaderSize is {}", skipped));
    if (skipped > 0) image.data.skip(static_cast<std::uint64_t>(skipped));
    if (skipped == -1) {  // the voxels are at the end of the file
        image.data.expect(declared_bytes(image));
        image.data.skip(image.data.stored_bytes_left() - declared_bytes(image));
    }
    if (!compressed && !image.encoding.text) note_bytes_left(image, options);
    if (!compressed) return;
    const std::int64_t size = header.has("CompressedDataSize") ? header.integers("CompressedDataSize", 1)[0] : 0;
    if (size < 0 || static_cast<std::uint64_t>(size) > image.data.stored_bytes_left())
        header.refuse(ErrorKind::corrupt_file, fmt::format("its CompressedDataSize is {}, but {} bytes are there", size,
                                                           image.data.stored_bytes_left()));
    image.data.inflate();
}

OpenImage open_metaimage(const fs::path& path, const ReadImageOptions& options) {
    InputFile file(path);
    const TextHeader header = read_header(file);
    if (header.find("ObjectType").value_or("Image") != "Image")
        header.refuse(ErrorKind::unsupported, fmt::format("it holds a {}, no image", header.text("ObjectType")));
    const std::int64_t dimension = header.integers("NDims", 1)[0];
    if (dimension != 3 && dimension != 4)
        header.refuse(ErrorKind::unsupported,
                      fmt::format("it has {} axes; 3 of space and at most one of frames are read", dimension));
    const auto axes = static_cast<std::size_t>(dimension);
    const auto sizes = header.integers("DimSize", axes);
    refuse_intensity_function(header);
    VoxelEncoding encoding;
    encoding.type = voxel_type(header);
    encoding.big_endian = flag(header, "BinaryDataByteOrderMSB", false);
    encoding.text = !flag(header, "BinaryData", true);
    encoding.components = component_count(header, sizes, encoding.interleaved);
    const Grid grid{{sizes[0], sizes[1], sizes[2]}, index_to_mm(header, axes, options)};
    check_header_grid(grid, path);
    OpenImage image{grid, encoding, data_file(std::move(file), header)};
    advance_to_voxels(image, header, options);
    return image;
}

template <typename Value>
std::string_view type_name() {
    if constexpr (std::is_same_v<Value, std::uint8_t>) return "MET_UCHAR";
    else if constexpr (std::is_same_v<Value, std::int16_t>) return "MET_SHORT";
    else if constexpr (std::is_same_v<Value, std::uint16_t>) return "MET_USHORT";
    else if constexpr (std::is_same_v<Value, std::int32_t>) return "MET_INT";
    else return "MET_FLOAT";
}

std::string header_text(const ImageView& image, std::size_t compressed_bytes) {
    const Affine3& affine = image.grid.index_to_mm;
    const Vec3 spacing = image.grid.spacing_mm();
    const Index3& size = image.grid.size;
    const auto type = std::visit([]<typename Value>(std::span<const Value>) { return type_name<Value>(); }, image.samples);
    std::string matrix;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 direction = affine.column(axis) / spacing[axis];
        matrix += fmt::format("{}{} {} {}", axis ? " " : "", direction.x, direction.y, direction.z);
    }
    std::string text = "ObjectType = Image\nNDims = 3\n";
    if (!image.provenance.empty())
        text += fmt::format("Comment = kontur {}\n", short_text(image.provenance, kMaxCommentBytes));
    text += "BinaryData = True\nBinaryDataByteOrderMSB = False\n";
    text += fmt::format("CompressedData = True\nCompressedDataSize = {}\n", compressed_bytes);
    text += fmt::format("TransformMatrix = {}\n", matrix);
    text += fmt::format("Offset = {} {} {}\n", affine.translation.x, affine.translation.y, affine.translation.z);
    text += fmt::format("ElementSpacing = {} {} {}\n", spacing.x, spacing.y, spacing.z);
    text += fmt::format("DimSize = {} {} {}\n", size.i, size.j, size.k);
    text += fmt::format("ElementType = {}\nElementDataFile = LOCAL\n", type);
    return text;
}

}  // namespace

Image read_metaimage(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    return read_voxels(open_metaimage(path, options), options, work);
}

Grid read_metaimage_grid(const fs::path& path, const ReadImageOptions& options) {
    return open_metaimage(path, options).grid;
}

std::optional<std::string> metaimage_data_file(const fs::path& path) {
    InputFile file(path);
    const std::string name = read_header(file).text("ElementDataFile");
    if (is_local(name) || is_list(name)) return std::nullopt;
    return name;
}

void write_metaimage(const fs::path& path, const ImageView& image) {
    check_grid(image.grid);
    // The header states the compressed size, so compression comes first.
    std::string compressed;
    Deflater deflater(
        DeflateFormat::zlib,
        [&](const void* data, std::size_t count) { compressed.append(static_cast<const char*>(data), count); },
        deflate_mode(image));
    deflater.write(bytes_of(image));
    deflater.finish();
    write_file_atomically(path, [&](AtomicFile& file) {
        file.write(header_text(image, compressed.size()));
        file.write(compressed);
    });
}

}  // namespace kontur
