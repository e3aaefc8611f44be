// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/nrrd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "kontur/base/printable.h"
#include "kontur/io/geometry/affine_frame.h"

namespace kontur {
namespace {

constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxHeaderBytes = std::size_t{1} << 24;

/// Names that the format has changed over time, or allows in two spellings.
std::string canonical_field(std::string_view name) {
    static const std::map<std::string, std::string, std::less<>> kSynonyms{
        {"datafile", "data file"}, {"lineskip", "line skip"}, {"byteskip", "byte skip"}};
    const std::string lower = lower_case(trimmed(name));
    const auto found = kSynonyms.find(lower);
    return found == kSynonyms.end() ? lower : found->second;
}

std::string unescaped(std::string_view text) {
    std::string plain;
    for (std::size_t n = 0; n < text.size(); ++n) {
        const bool escape = text[n] == '\\' && n + 1 < text.size() && (text[n + 1] == 'n' || text[n + 1] == '\\');
        plain += escape && text[n + 1] == 'n' ? '\n' : text[n];
        if (escape) ++n;
    }
    return plain;
}

void add_line(std::string_view line, NrrdHeader& header) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos)
        header.fields.refuse(ErrorKind::corrupt_file,
                             fmt::format("its header line \"{}\" has no colon", line.substr(0, 40)));
    const std::string_view rest = line.substr(colon + 1);
    if (rest.starts_with('=')) header.keys.emplace(unescaped(line.substr(0, colon)), unescaped(rest.substr(1)));
    else header.fields.add(canonical_field(line.substr(0, colon)), rest);
}

VoxelType voxel_type(const TextHeader& fields) {
    static const std::map<std::string, VoxelType, std::less<>> kTypes{
        {"signed char", VoxelType::int8},
        {"int8", VoxelType::int8},
        {"int8_t", VoxelType::int8},
        {"uchar", VoxelType::uint8},
        {"unsigned char", VoxelType::uint8},
        {"uint8", VoxelType::uint8},
        {"uint8_t", VoxelType::uint8},
        {"short", VoxelType::int16},
        {"short int", VoxelType::int16},
        {"signed short", VoxelType::int16},
        {"signed short int", VoxelType::int16},
        {"int16", VoxelType::int16},
        {"int16_t", VoxelType::int16},
        {"ushort", VoxelType::uint16},
        {"unsigned short", VoxelType::uint16},
        {"unsigned short int", VoxelType::uint16},
        {"uint16", VoxelType::uint16},
        {"uint16_t", VoxelType::uint16},
        {"int", VoxelType::int32},
        {"signed int", VoxelType::int32},
        {"int32", VoxelType::int32},
        {"int32_t", VoxelType::int32},
        {"uint", VoxelType::uint32},
        {"unsigned int", VoxelType::uint32},
        {"uint32", VoxelType::uint32},
        {"uint32_t", VoxelType::uint32},
        {"longlong", VoxelType::int64},
        {"long long", VoxelType::int64},
        {"long long int", VoxelType::int64},
        {"signed long long", VoxelType::int64},
        {"signed long long int", VoxelType::int64},
        {"int64", VoxelType::int64},
        {"int64_t", VoxelType::int64},
        {"ulonglong", VoxelType::uint64},
        {"unsigned long long", VoxelType::uint64},
        {"unsigned long long int", VoxelType::uint64},
        {"uint64", VoxelType::uint64},
        {"uint64_t", VoxelType::uint64},
        {"float", VoxelType::float32},
        {"double", VoxelType::float64},
    };
    const std::string name = lower_case(fields.text("type"));
    const auto found = kTypes.find(name);
    if (found == kTypes.end()) fields.refuse(ErrorKind::unsupported, fmt::format("its type \"{}\" is not read", name));
    return found->second;
}

bool is_big_endian(const TextHeader& fields) {
    const std::string endian = lower_case(fields.text("endian"));
    if (endian != "little" && endian != "big")
        fields.refuse(ErrorKind::corrupt_file,
                      fmt::format("its field \"endian\" is \"{}\"; little or big is expected", endian));
    return endian == "big";
}

/// Signs that turn the file's space into LPS; nullopt for a space that says nothing about the patient.
std::optional<Vec3> signs_of_space(const TextHeader& fields) {
    std::string name = lower_case(fields.find("space").value_or(""));
    // Both spellings name the directions in the order x, y, z: "RAS" and "right-anterior-superior".
    std::string letters;
    for (std::size_t n = 0; n < name.size(); ++n)
        if (name.find('-') == std::string::npos || n == 0 || name[n - 1] == '-') letters += name[n];
    if (letters.size() != 3) return std::nullopt;
    constexpr std::array<std::string_view, 3> kKnown{"lr", "pa", "si"};
    Vec3 signs;
    for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<std::size_t>(axis);
        const std::size_t which = kKnown[index].find(letters[index]);
        if (which == std::string_view::npos) return std::nullopt;
        signs[axis] = which == 0 ? 1 : -1;
    }
    return signs;
}

/// "(1,0,0)".
Vec3 parse_vector(std::string_view text, const TextHeader& fields) {
    const std::string_view whole = text;
    Vec3 vector;
    const bool framed = text.starts_with('(') && text.ends_with(')');
    text = framed ? text.substr(1, text.size() - 2) : std::string_view{};
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = text.find(',');
        const auto number = parse_number(trimmed(text.substr(0, comma)));
        if (!number || (comma == std::string_view::npos) != (axis == 2))
            fields.refuse(ErrorKind::corrupt_file, fmt::format("\"{}\" is no vector of 3 numbers", whole));
        vector[axis] = *number;
        text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    }
    return vector;
}

/// The vectors of "space directions", nullopt for an axis that is not in space.
std::vector<std::optional<Vec3>> parse_directions(std::string_view text, const TextHeader& fields) {
    std::vector<std::optional<Vec3>> directions;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
        const bool is_vector = text.starts_with('(');
        const std::size_t end = is_vector ? text.find(')') : text.find_first_of(" \t");
        const std::string_view part = text.substr(0, end == std::string_view::npos ? end : end + (is_vector ? 1 : 0));
        if (is_vector) directions.push_back(parse_vector(part, fields));
        else if (part == "none") directions.push_back(std::nullopt);
        else fields.refuse(ErrorKind::corrupt_file, fmt::format("\"{}\" is no space direction", part));
        text.remove_prefix(part.size());
    }
    return directions;
}

/// Directions from "spacings" (NaN: not in space), for files that state nothing better.
std::vector<std::optional<Vec3>> directions_by_spacing(const TextHeader& fields, std::size_t axes) {
    std::vector<std::optional<Vec3>> directions;
    int axis = 0;
    for (const double spacing : fields.numbers("spacings", axes)) {
        if (std::isnan(spacing) || axis == 3) {
            directions.push_back(std::nullopt);
            continue;
        }
        Vec3 direction;
        direction[axis++] = spacing;
        directions.push_back(direction);
    }
    return directions;
}

double mm_per_unit(const TextHeader& fields) {
    static const std::map<std::string, double, std::less<>> kUnits{
        {"mm", 1},         {"", 1},           {"cm", 10}, {"m", 1000}, {"um", 0.001}, {"\xc2\xb5m", 0.001},
        {"micron", 0.001}, {"microns", 0.001}};
    std::string first;
    int number = 0;
    const std::string units = fields.find("space units").value_or("");
    for (const std::string_view word : words(units)) {
        std::string unit(word);
        std::erase(unit, '"');
        if (number++ == 0) first = unit;
        if (unit != first || !kUnits.contains(unit))
            fields.refuse(ErrorKind::unsupported,
                          fmt::format("its space units \"{}\" are not read; mm, cm, m or um for all axes are", unit));
    }
    return kUnits.find(first)->second;
}

[[noreturn]] void refuse_missing(const TextHeader& fields, const std::string& what) {
    fields.refuse(
        ErrorKind::unsupported,
        fmt::format(
            "it does not say how it lies in the patient ({}); the option allow_missing_geometry reads it along L, P, S",
            what));
}

/// The index of the one axis that is not in space, nullopt when all are.
std::optional<std::size_t> component_axis(const std::vector<std::optional<Vec3>>& directions, const TextHeader& fields) {
    std::optional<std::size_t> found;
    for (std::size_t axis = 0; axis < directions.size(); ++axis)
        if (!directions[axis]) {
            if (found)
                fields.refuse(
                    ErrorKind::unsupported,
                    "more than one of its axes is not in space; one at most is read, so save a single channel first");
            found = axis;
        }
    if (directions.size() - (found ? 1 : 0) != 3)
        fields.refuse(ErrorKind::unsupported,
                      fmt::format("{} of its axes are in space; 3 are needed", directions.size() - (found ? 1 : 0)));
    if (found && *found != 0 && *found != 3)
        fields.refuse(
            ErrorKind::unsupported,
            fmt::format("its axis {} is not in space; only the first or the last may be so; 3D Slicer saves it that way",
                        *found + 1));
    return found;
}

}  // namespace

NrrdHeader read_nrrd_header(InputFile& file) {
    NrrdHeader header{TextHeader(file.path()), {}};
    const auto first = file.read_line(kMaxLineBytes);
    if (!first || first->size() != 8 || !first->starts_with("NRRD000") || (*first)[7] < '1' || (*first)[7] > '5')
        header.fields.refuse(ErrorKind::corrupt_file, "it is no NRRD file of version 1 to 5");
    std::size_t bytes = 0;
    while (const auto line = file.read_line(kMaxLineBytes)) {
        if (line->empty()) return header;
        bytes += line->size();
        if (bytes > kMaxHeaderBytes)
            header.fields.refuse(ErrorKind::too_large, fmt::format("its header is longer than {} bytes", kMaxHeaderBytes));
        if (!line->starts_with('#')) add_line(*line, header);
    }
    if (!header.fields.has("data file")) header.fields.refuse(ErrorKind::corrupt_file, "it ends within its header");
    return header;
}

NrrdLayout nrrd_layout(const TextHeader& fields, const ReadImageOptions& options) {
    const std::int64_t dimension = fields.integers("dimension", 1)[0];
    if (dimension != 3 && dimension != 4)
        fields.refuse(ErrorKind::unsupported,
                      fmt::format("it has {} axes; 3 of space and at most one of layers are read", dimension));
    const auto axes = static_cast<std::size_t>(dimension);
    const auto signs = signs_of_space(fields);
    if (!options.allow_missing_geometry) {
        if (!signs) refuse_missing(fields, "it names no space such as left-posterior-superior");
        if (!fields.has("space directions")) refuse_missing(fields, "it has no space directions");
        if (!fields.has("space origin")) refuse_missing(fields, "it has no space origin");
    }
    const auto directions = fields.has("space directions") ? parse_directions(fields.text("space directions"), fields)
                                                           : directions_by_spacing(fields, axes);
    if (directions.size() != axes)
        fields.refuse(ErrorKind::corrupt_file,
                      fmt::format("it has {} space directions for {} axes", directions.size(), axes));
    const auto component = component_axis(directions, fields);
    const auto sizes = fields.integers("sizes", axes);

    NrrdLayout layout;
    int space_axis = 0;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        if (axis == component) continue;
        layout.grid.size[space_axis] = sizes[axis];
        layout.grid.index_to_mm.set_column(space_axis++, *directions[axis]);
    }
    if (const auto origin = fields.find("space origin")) layout.grid.index_to_mm.translation = parse_vector(*origin, fields);
    layout.grid.index_to_mm =
        scaled(with_axes_turned(layout.grid.index_to_mm, signs.value_or(Vec3{1, 1, 1})), mm_per_unit(fields));
    check_header_grid(layout.grid, fields.path());

    VoxelEncoding& encoding = layout.encoding;
    encoding.type = voxel_type(fields);
    encoding.components = component ? sizes[*component] : 1;
    if (encoding.components < 1)
        fields.refuse(ErrorKind::corrupt_file, fmt::format("it declares {} layers", encoding.components));
    encoding.interleaved = component == 0u;
    const std::string name = lower_case(fields.text("encoding"));
    encoding.text = name == "ascii" || name == "text" || name == "txt";
    encoding.big_endian = !encoding.text && byte_size(encoding.type) > 1 && is_big_endian(fields);
    return layout;
}

}  // namespace kontur
