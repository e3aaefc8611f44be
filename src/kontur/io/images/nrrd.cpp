// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/nrrd.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/deflate.h"
#include "kontur/io/images/nrrd_header.h"
#include "kontur/io/images/nrrd_text.h"
#include "kontur/io/images/voxel_stream.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxSkippedLineBytes = std::size_t{1} << 20;

/// Several files, named one by one or by a pattern.
bool is_list(const std::string& name) { return name.starts_with("LIST") || name.find('%') != std::string::npos; }

/// The file that holds the voxels: the header's own one, unless it names another.
InputFile data_file(InputFile&& header_file, const TextHeader& fields) {
    const auto name = fields.find("data file");
    if (!name) return std::move(header_file);
    if (is_list(*name))
        fields.refuse(ErrorKind::unsupported,
                      "its voxels are in several files, which is not read; save it as one first, with 3D Slicer say");
    return open_beside(fields.path(), *name);
}

std::int64_t skip_count(const TextHeader& fields, const std::string& field, std::int64_t lowest) {
    const std::int64_t count = fields.has(field) ? fields.integers(field, 1)[0] : 0;
    if (count < lowest) fields.refuse(ErrorKind::corrupt_file, fmt::format("its field \"{}\" is {}", field, count));
    return count;
}

/// From the start of the data to the first voxel: lines before the decompression, bytes behind it.
void advance_to_voxels(OpenImage& image, const TextHeader& fields, const ReadImageOptions& options) {
    const std::string encoding = lower_case(fields.text("encoding"));
    const bool gzip = encoding == "gzip" || encoding == "gz", bzip2 = encoding == "bzip2" || encoding == "bz2";
    const bool raw = encoding == "raw";
    if (!gzip && !bzip2 && !raw && !image.encoding.text)
        fields.refuse(ErrorKind::unsupported,
                      fmt::format("its encoding \"{}\" is not read; raw, gzip, bzip2 and text are", encoding));
    for (std::int64_t n = skip_count(fields, "line skip", 0); n > 0; --n)
        if (!image.data.read_line(kMaxSkippedLineBytes)) fields.refuse(ErrorKind::corrupt_file, "it ends before its voxels");
    if (gzip ? !image.data.at_gzip() : bzip2 && !image.data.at_bzip2())
        fields.refuse(ErrorKind::corrupt_file,
                      fmt::format("its voxels are not compressed by {} as declared", gzip ? "gzip" : "bzip2"));
    if (gzip) image.data.inflate();
    if (bzip2) image.data.bunzip2();
    const std::int64_t bytes = skip_count(fields, "byte skip", raw ? -1 : 0);
    if (bytes >= 0) {
        image.data.skip(static_cast<std::uint64_t>(bytes));
        if (raw) note_bytes_left(image, options);
        return;
    }
    // -1: the voxels are at the end of the file.
    image.data.expect(declared_bytes(image));
    image.data.skip(image.data.stored_bytes_left() - declared_bytes(image));
}

OpenImage open_nrrd(const fs::path& path, const ReadImageOptions& options) {
    InputFile file(path);
    const NrrdHeader header = read_nrrd_header(file);
    const NrrdLayout layout = nrrd_layout(header.fields, options);
    OpenImage image{layout.grid, layout.encoding, data_file(std::move(file), header.fields)};
    advance_to_voxels(image, header.fields, options);
    return image;
}

template <typename Value>
std::string_view type_name() {
    if constexpr (std::is_same_v<Value, std::uint8_t>) return "uint8";
    else if constexpr (std::is_same_v<Value, std::int16_t>) return "int16";
    else if constexpr (std::is_same_v<Value, std::uint16_t>) return "uint16";
    else if constexpr (std::is_same_v<Value, std::int32_t>) return "int32";
    else return "float";
}

std::string header_text(const ImageView& image) {
    const auto type = std::visit([]<typename Value>(std::span<const Value>) { return type_name<Value>(); }, image.samples);
    return nrrd_header_text(image.grid, type, 1, image.provenance);
}

void write(const fs::path& path, const ImageView& image, const std::string& more_lines) {
    check_grid(image.grid);
    write_file_atomically(path, [&](AtomicFile& file) {
        file.write(header_text(image) + more_lines + "\n");
        Deflater deflater(
            DeflateFormat::gzip, [&](const void* data, std::size_t count) { file.write(data, count); }, deflate_mode(image));
        deflater.write(bytes_of(image));
        deflater.finish();
    });
}

/// First and last index along each axis of the voxels with this value, as 3D Slicer writes it; "0 -1" when there are none.
std::string extent_text(const ImageView& image, std::int64_t label) {
    const Index3& size = image.grid.size;
    Index3 low = size, high{-1, -1, -1};
    std::visit(
        [&](const auto& values) {
            std::size_t offset = 0;
            for (Index3 at; at.k < size.k; ++at.k)
                for (at.j = 0; at.j < size.j; ++at.j)
                    for (at.i = 0; at.i < size.i; ++at.i, ++offset) {
                        if (static_cast<std::int64_t>(values[offset]) != label) continue;
                        for (int axis = 0; axis < 3; ++axis) {
                            low[axis] = std::min(low[axis], at[axis]);
                            high[axis] = std::max(high[axis], at[axis]);
                        }
                    }
        },
        image.samples);
    if (high.i < 0) low = {};
    return fmt::format("{} {} {} {} {} {}", low.i, high.i, low.j, high.j, low.k, high.k);
}

}  // namespace

Image read_nrrd(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    return read_voxels(open_nrrd(path, options), options, work);
}

Grid read_nrrd_grid(const fs::path& path, const ReadImageOptions& options) { return open_nrrd(path, options).grid; }

std::optional<std::string> nrrd_data_file(const fs::path& path) {
    InputFile file(path);
    const auto name = read_nrrd_header(file).fields.find("data file");
    return name && is_list(*name) ? std::nullopt : name;
}

void write_nrrd(const fs::path& path, const ImageView& image) { write(path, image, ""); }

void write_seg_nrrd(const fs::path& path, const ImageView& labels, std::span<const NrrdSegment> segments) {
    if (std::holds_alternative<std::span<const float>>(labels.samples))
        throw Error(ErrorKind::unsupported, path.string() + ": a segmentation needs integer labels, not floats");
    std::string keys = segmentation_keys();
    for (const NrrdSegment& segment : segments) check_utf8(segment.name, "the segment's name");
    for (std::size_t n = 0; n < segments.size(); ++n)
        keys += segment_keys(n, segments[n], extent_text(labels, segments[n].label_value));
    write(path, labels, keys);
}

std::vector<NrrdSegment> read_nrrd_segments(const fs::path& path) {
    InputFile file(path);
    const NrrdHeader header = read_nrrd_header(file);
    const auto value_of = [&](std::size_t number, const char* key) -> std::optional<std::string> {
        const auto found = header.keys.find(fmt::format("Segment{}_{}", number, key));
        if (found == header.keys.end()) return std::nullopt;
        return found->second;
    };
    // Files of 3D Slicer before 4.11 have one layer for each segment, with the value 1; those of three axes have one layer.
    const bool has_layers = header.fields.find("dimension").value_or("") != "3";
    std::vector<NrrdSegment> segments;
    while (value_of(segments.size(), "ID")) {
        const std::size_t number = segments.size();
        NrrdSegment segment;
        segment.name = value_of(number, "Name").value_or(*value_of(number, "ID"));
        if (!is_utf8(segment.name)) segment.name = latin1_to_utf8(segment.name);
        const std::string label = value_of(number, "LabelValue").value_or("1");
        const std::optional<std::int64_t> label_value = parse_integer(trimmed(label));
        if (!label_value)
            header.fields.refuse(
                ErrorKind::corrupt_file,
                fmt::format("the label value of its segment {} is \"{}\", which is no integer", number, label));
        segment.label_value = *label_value;
        segment.layer = has_layers ? static_cast<std::int64_t>(number) : 0;
        if (const auto layer = value_of(number, "Layer")) segment.layer = parse_integer(*layer).value_or(0);
        segment.tags = value_of(number, "Tags").value_or("");
        const std::string color = value_of(number, "Color").value_or("");
        const auto parts = words(color);
        for (std::size_t n = 0; n < parts.size() && n < 3; ++n) segment.color[n] = parse_number(parts[n]).value_or(0);
        segments.push_back(segment);
    }
    return segments;
}

std::vector<std::int64_t> segment_numbers(std::span<const NrrdSegment> segments) {
    std::vector<std::int64_t> numbers;
    for (const NrrdSegment& segment : segments) numbers.push_back(segment.label_value);
    std::vector<std::int64_t> sorted = numbers;
    std::ranges::sort(sorted);
    if (std::ranges::adjacent_find(sorted) != sorted.end()) std::iota(numbers.begin(), numbers.end(), 1);
    return numbers;
}

const NrrdSegment* segment_of_number(std::span<const NrrdSegment> segments, std::int64_t number) {
    const std::vector<std::int64_t> numbers = segment_numbers(segments);
    const auto found = std::ranges::find(numbers, number);
    return found == numbers.end() ? nullptr : &segments[static_cast<std::size_t>(found - numbers.begin())];
}

void check_segment_choice(std::span<const NrrdSegment> segments, std::optional<std::int64_t> number, const fs::path& path) {
    const bool has_layers = std::ranges::any_of(segments, [](const NrrdSegment& segment) { return segment.layer != 0; });
    if (!has_layers || (number && segment_of_number(segments, *number))) return;
    std::string all;
    const std::vector<std::int64_t> numbers = segment_numbers(segments);
    for (std::size_t n = 0; n < segments.size(); ++n)
        all += fmt::format("{}{} '{}'", n == 0 ? "" : ", ", numbers[n], segments[n].name);
    throw Error(ErrorKind::invalid_input,
                number ? fmt::format("{} has no segment {}; it has {}", path.string(), *number, all)
                       : fmt::format("{} has {} on several layers; choose one with the option label: {}", path.string(),
                                     counted(segments.size(), "segment"), all));
}

}  // namespace kontur
