// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/meshes/mesh_formats.h"

static_assert(std::endian::native == std::endian::little, "bytes are swapped for big-endian files only");

namespace kontur {
namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyCoding { text, little_endian, big_endian };

struct PlyProperty {
    std::string_view name;
    PlyType type;
    std::optional<PlyType> list_count;  ///< set for a list: the type of its length
};

struct PlyElement {
    std::string_view name;
    std::uint64_t count;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyCoding coding = PlyCoding::text;
    PatientFrame frame = PatientFrame::lps;
    std::vector<PlyElement> elements;
};

PlyType type_of(std::string_view word) {
    struct Name {
        std::string_view name;
        PlyType type;
    };
    constexpr std::array<Name, 16> names{{{"char", PlyType::int8},
                                          {"int8", PlyType::int8},
                                          {"uchar", PlyType::uint8},
                                          {"uint8", PlyType::uint8},
                                          {"short", PlyType::int16},
                                          {"int16", PlyType::int16},
                                          {"ushort", PlyType::uint16},
                                          {"uint16", PlyType::uint16},
                                          {"int", PlyType::int32},
                                          {"int32", PlyType::int32},
                                          {"uint", PlyType::uint32},
                                          {"uint32", PlyType::uint32},
                                          {"float", PlyType::float32},
                                          {"float32", PlyType::float32},
                                          {"double", PlyType::float64},
                                          {"float64", PlyType::float64}}};
    const auto found = std::find_if(names.begin(), names.end(), [&](const Name& n) { return n.name == word; });
    if (found == names.end())
        throw Error(ErrorKind::corrupt_file, fmt::format("\"{}\" is no PLY number type", word.substr(0, 40)));
    return found->type;
}

std::size_t size_of(PlyType type) {
    constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

PlyCoding coding_of(std::string_view word) {
    if (word == "ascii") return PlyCoding::text;
    if (word == "binary_little_endian") return PlyCoding::little_endian;
    if (word == "binary_big_endian") return PlyCoding::big_endian;
    throw Error(ErrorKind::corrupt_file, fmt::format("\"{}\" is no PLY coding", word.substr(0, 40)));
}

PlyProperty property_of(std::string_view line) {
    const std::string_view first = take_word(line);
    if (first != "list") return {take_word(line), type_of(first), std::nullopt};
    const PlyType count_type = type_of(take_word(line)), item_type = type_of(take_word(line));
    return {take_word(line), item_type, count_type};
}

/// Cuts the header off `bytes`.
PlyHeader take_header(std::string_view& bytes) {
    if (take_line(bytes) != "ply") throw Error(ErrorKind::corrupt_file, "no PLY file: the first line is not \"ply\"");
    PlyHeader header;
    while (!bytes.empty()) {
        const std::string_view line = take_line(bytes);
        std::string_view rest = line;
        const std::string_view keyword = take_word(rest);
        if (keyword == "end_header") return header;
        if (keyword == "format") header.coding = coding_of(take_word(rest));
        else if (keyword == "comment" || keyword == "obj_info") header.frame = declared_frame(line, header.frame);
        else if (keyword == "element") {
            const std::string_view name = take_word(rest);
            const std::int64_t count = integer_of(take_word(rest));
            if (count < 0)
                throw Error(ErrorKind::corrupt_file, fmt::format("the PLY header declares {} of \"{}\"", count, name));
            header.elements.push_back({name, static_cast<std::uint64_t>(count), {}});
        } else if (keyword == "property") {
            if (header.elements.empty()) throw Error(ErrorKind::corrupt_file, "a PLY property before any element");
            header.elements.back().properties.push_back(property_of(rest));
        } else {
            throw Error(ErrorKind::corrupt_file, fmt::format("\"{}\" in the PLY header", keyword.substr(0, 40)));
        }
    }
    throw Error(ErrorKind::corrupt_file, "the PLY header does not end");
}

/// The numbers behind the header, one after the other.
class PlyNumbers {
public:
    PlyNumbers(std::string_view bytes, PlyCoding coding) : bytes_(bytes), coding_(coding) {}

    double next(PlyType type) {
        if (coding_ == PlyCoding::text) return number_of(take_word(bytes_));
        switch (type) {
            case PlyType::int8:
                return take<std::int8_t>();
            case PlyType::uint8:
                return take<std::uint8_t>();
            case PlyType::int16:
                return take<std::int16_t>();
            case PlyType::uint16:
                return take<std::uint16_t>();
            case PlyType::int32:
                return take<std::int32_t>();
            case PlyType::uint32:
                return take<std::uint32_t>();
            case PlyType::float32:
                return take<float>();
            case PlyType::float64:
                break;
        }
        return take<double>();
    }

    /// Length of a list whose items all fit into what is left.
    std::uint64_t next_length(const PlyProperty& list) {
        const double length = next(*list.list_count);
        const std::size_t most_items = bytes_.size() / least_size(list.type);
        const auto most = static_cast<double>(most_items);
        if (!(length >= 0 && length <= most && length == std::floor(length)))
            throw Error(ErrorKind::corrupt_file,
                        fmt::format("a list of {} \"{}\" with {} bytes left in the file", length, list.name, bytes_.size()));
        return static_cast<std::uint64_t>(length);
    }

    /// Throws unless the rest of the file can hold the element's declared count.
    void expect(const PlyElement& element) const {
        if (element.properties.empty())
            throw Error(ErrorKind::corrupt_file, fmt::format("the PLY element \"{}\" has no properties", element.name));
        std::uint64_t least = 0;
        for (const PlyProperty& p : element.properties) least += least_size(p.list_count.value_or(p.type));
        if (element.count > bytes_.size() / least)
            throw Error(ErrorKind::corrupt_file,
                        fmt::format("the header declares {} of \"{}\", at least {} bytes each, but {} bytes follow",
                                    element.count, element.name, least, bytes_.size()));
    }

private:
    /// In text a number is at least a digit; the blank behind it may be missing at the very end only.
    std::size_t least_size(PlyType type) const { return coding_ == PlyCoding::text ? 1 : size_of(type); }

    template <class Number>
    Number take() {
        std::array<char, sizeof(Number)> raw;
        if (bytes_.size() < raw.size()) throw Error(ErrorKind::corrupt_file, "the file ends amid its data");
        std::copy_n(bytes_.data(), raw.size(), raw.data());
        bytes_.remove_prefix(raw.size());
        if (coding_ == PlyCoding::big_endian) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<Number>(raw);
    }

    std::string_view bytes_;
    PlyCoding coding_;
};

/// Where a point element keeps x, y, z or nx, ny, nz; nullopt unless all three are there.
std::optional<std::array<std::size_t, 3>> columns(const PlyElement& element, const std::array<std::string_view, 3>& names) {
    std::array<std::size_t, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                        [&](const PlyProperty& p) { return p.name == names[i] && !p.list_count; });
        if (found == element.properties.end()) return std::nullopt;
        result[i] = static_cast<std::size_t>(found - element.properties.begin());
    }
    return result;
}

void skip_list(PlyNumbers& numbers, const PlyProperty& list) {
    for (auto length = numbers.next_length(list); length > 0; --length) numbers.next(list.type);
}

void read_points(PlyNumbers& numbers, const PlyElement& element, PatientFrame frame, TriangleMesh& mesh) {
    if (element.count > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorKind::too_large, fmt::format("{} points; at most 2^32 - 1 are possible", element.count));
    if (!mesh.points.empty()) throw Error(ErrorKind::corrupt_file, "the PLY header declares the points twice");
    const auto xyz = columns(element, {"x", "y", "z"}), normal = columns(element, {"nx", "ny", "nz"});
    if (!xyz) throw Error(ErrorKind::corrupt_file, "the PLY points have no x, y and z");
    mesh.points.reserve(element.count);
    std::vector<double> row(element.properties.size());
    const auto vector_at = [&](const std::array<std::size_t, 3>& c) {
        return to_lps(frame, {row[c[0]], row[c[1]], row[c[2]]});
    };
    for (std::uint64_t i = 0; i < element.count; ++i) {
        for (std::size_t p = 0; p < row.size(); ++p)
            if (element.properties[p].list_count) skip_list(numbers, element.properties[p]);
            else row[p] = numbers.next(element.properties[p].type);
        mesh.points.push_back(vector_at(*xyz));
        if (!is_finite(mesh.points.back()))
            throw Error(ErrorKind::corrupt_file, fmt::format("point {} is not finite", i + 1));
        if (normal) mesh.normals.push_back(vector_at(*normal));
    }
}

/// Corners are checked against the number of points afterwards: the points may follow.
void read_faces(PlyNumbers& numbers, const PlyElement& element, TriangleMesh& mesh) {
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties) {
            if (!property.list_count) {
                numbers.next(property.type);
            } else if (property.name != "vertex_indices" && property.name != "vertex_index") {
                skip_list(numbers, property);
            } else {
                corners.clear();
                for (auto length = numbers.next_length(property); length > 0; --length) {
                    const double index = numbers.next(property.type);
                    if (!(index >= 0 && index <= std::numeric_limits<std::uint32_t>::max() && index == std::floor(index)))
                        throw Error(ErrorKind::corrupt_file, fmt::format("face {} refers to point {}", i + 1, index));
                    corners.push_back(static_cast<std::uint32_t>(index));
                }
                if (corners.size() < 3)
                    throw Error(ErrorKind::corrupt_file,
                                fmt::format("face {} has {} corners; at least 3 are needed", i + 1, corners.size()));
                append_polygon(mesh, corners);
            }
        }
}

void skip_element(PlyNumbers& numbers, const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties)
            if (property.list_count) skip_list(numbers, property);
            else numbers.next(property.type);
}

void check_corners(const TriangleMesh& mesh) {
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            if (corner >= mesh.points.size())
                throw Error(ErrorKind::corrupt_file,
                            fmt::format("a face refers to point {}, counted from 0, of {}", corner, mesh.points.size()));
}

template <class Number>
void append(std::string& bytes, Number value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    bytes.append(raw.data(), raw.size());
}

}  // namespace

void write_ply(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance) {
    write_ply(file, mesh, {}, provenance);
}

void write_ply(AtomicFile& file, const TriangleMesh& mesh, const PlyExtras& extras, const Provenance& provenance) {
    const auto& [values, regions] = extras;
    std::string comments;
    for (const auto& [name, value] : provenance) comments += fmt::format("comment kontur {}: {}\n", name, value);
    if (regions)
        for (std::size_t n = 0; n < regions->names.size(); ++n)
            comments += fmt::format("comment kontur region {}: {}\n", n, printable_utf8(regions->names[n]));
    file.write(
        fmt::format("ply\nformat binary_little_endian 1.0\ncomment kontur {}\ncomment SPACE=LPS\ncomment UNIT=mm\n{}"
                    "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n{}{}"
                    "element face {}\nproperty list uchar uint vertex_indices\n{}end_header\n",
                    KONTUR_VERSION, comments, mesh.points.size(),
                    mesh.normals.empty() ? "" : "property float nx\nproperty float ny\nproperty float nz\n",
                    values ? fmt::format("property float {}\n", values->name) : "", mesh.triangles.size(),
                    regions ? "property uint behind\nproperty uint front\n" : ""));
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        std::string row;
        for (int axis = 0; axis < 3; ++axis) append(row, mesh.points[i][axis]);
        if (!mesh.normals.empty())
            for (int axis = 0; axis < 3; ++axis) append(row, static_cast<float>(mesh.normals[i][axis]));
        if (values) append(row, static_cast<float>(values->values[i]));
        file.write(row);
    }
    for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
        std::string row(1, '\3');
        for (const std::uint32_t corner : mesh.triangles[n]) append(row, corner);
        if (regions)
            for (const std::uint32_t region : regions->sides[n]) append(row, region);
        file.write(row);
    }
}

TriangleMesh parse_ply(std::string_view bytes) {
    const PlyHeader header = take_header(bytes);
    PlyNumbers numbers(bytes, header.coding);
    TriangleMesh mesh;
    for (const PlyElement& element : header.elements) {
        numbers.expect(element);
        if (element.name == "vertex") read_points(numbers, element, header.frame, mesh);
        else if (element.name == "face") read_faces(numbers, element, mesh);
        else skip_element(numbers, element);
    }
    check_corners(mesh);
    return mesh;
}

}  // namespace kontur
