// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "kontur/base/error.h"
#include "kontur/io/bytes/base64.h"
#include "kontur/io/bytes/byte_order.h"
#include "kontur/io/bytes/decompress.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/bytes/xml_tags.h"
#include "kontur/io/meshes/mesh_formats.h"
#include "kontur/io/meshes/polydata.h"

namespace kontur {
namespace {

[[noreturn]] void corrupt(const std::string& reason) { throw Error(ErrorKind::corrupt_file, reason); }
[[noreturn]] void unsupported(const std::string& reason) { throw Error(ErrorKind::unsupported, reason); }

/// What the file's first tag says of all arrays.
struct Coding {
    bool big_endian = false;
    bool wide_counts = false;  ///< counts of bytes have 64 bits
    bool compressed = false;   ///< by zlib
    std::string_view appended;
    bool appended_base64 = false;
};

template <class Stored>
double number_at(const unsigned char* raw, bool big_endian) {
    return static_cast<double>(load<Stored>(raw, big_endian));
}

struct NumberType {
    std::string_view name;
    std::size_t bytes;
    double (*load)(const unsigned char*, bool);
};
constexpr std::array kNumberTypes{
    NumberType{"Int8", 1, number_at<std::int8_t>},   NumberType{"UInt8", 1, number_at<std::uint8_t>},
    NumberType{"Int16", 2, number_at<std::int16_t>}, NumberType{"UInt16", 2, number_at<std::uint16_t>},
    NumberType{"Int32", 4, number_at<std::int32_t>}, NumberType{"UInt32", 4, number_at<std::uint32_t>},
    NumberType{"Int64", 8, number_at<std::int64_t>}, NumberType{"UInt64", 8, number_at<std::uint64_t>},
    NumberType{"Float32", 4, number_at<float>},      NumberType{"Float64", 8, number_at<double>}};

const NumberType& number_type(std::string_view name) {
    for (const NumberType& type : kNumberTypes)
        if (type.name == name) return type;
    unsupported(fmt::format("arrays of type \"{}\" are not read", name.substr(0, 40)));
}

/// Bytes of an array one after the other, in base64 or as they are.
class ArrayBytes {
public:
    ArrayBytes(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

    /// All that is there.
    std::size_t most() const { return is_base64_ ? text_.size() / 4 * 3 : text_.size(); }

    /// The first bytes.
    std::string first(std::size_t count) const {
        if (count > most()) corrupt(fmt::format("an array of {} bytes is declared where {} can be", count, most()));
        std::string bytes = is_base64_ ? from_base64(text_, count) : std::string(text_.substr(0, count));
        if (bytes.size() < count) corrupt(fmt::format("an array ends after {} of {} bytes", bytes.size(), count));
        return bytes;
    }

private:
    std::string_view text_;
    bool is_base64_;
};

std::uint64_t count_at(const std::string& bytes, std::size_t n, const Coding& coding) {
    const auto* raw = reinterpret_cast<const unsigned char*>(bytes.data());
    return coding.wide_counts ? load<std::uint64_t>(raw + 8 * n, coding.big_endian)
                              : load<std::uint32_t>(raw + 4 * n, coding.big_endian);
}

/// A whole zlib stream that becomes exactly `size` bytes.
std::string inflated(std::string_view packed, std::size_t size) {
    const auto inflater = make_inflater(Inflation::gzip_or_zlib);
    if (size / inflater->most_inflation() > packed.size())
        corrupt(fmt::format("a block of {} bytes is declared where {} compressed ones are", size, packed.size()));
    std::string plain(size + 1, '\0');  // one more, by which a longer one is known
    std::size_t done = 0, used = 0;
    const auto* raw = reinterpret_cast<const unsigned char*>(packed.data());
    for (bool ended = false; !ended;) {
        const auto step = inflater->run({raw + used, packed.size() - used},
                                        {reinterpret_cast<unsigned char*>(plain.data()) + done, plain.size() - done});
        used += step.consumed;
        done += step.produced;
        ended = step.ended;
        if (step.damage || done > size || (!ended && step.consumed + step.produced == 0))
            corrupt("the compressed data of an array are damaged");
    }
    if (done != size) corrupt(fmt::format("a compressed block has {} bytes, not the declared {}", done, size));
    plain.resize(size);
    return plain;
}

/// Blocks of one size but for the last, each compressed by itself; their sizes stand in front.
std::string inflated_blocks(const ArrayBytes& stored, const Coding& coding) {
    const std::size_t width = coding.wide_counts ? 8 : 4;
    const std::string head = stored.first(3 * width);
    const std::uint64_t blocks = count_at(head, 0, coding), size = count_at(head, 1, coding),
                        last = count_at(head, 2, coding);
    if (blocks > stored.most() / width || last > size || size > std::numeric_limits<std::uint32_t>::max())
        corrupt(fmt::format("an array of {} compressed blocks of {} bytes is declared", blocks, size));
    // In base64, data and sizes are encoded each by itself, so that the sizes may end with padding; first() passes over it.
    const std::size_t head_bytes = (3 + static_cast<std::size_t>(blocks)) * width;
    const std::string sizes = stored.first(head_bytes);
    std::size_t packed_bytes = 0;
    for (std::size_t n = 0; n < blocks; ++n) {
        const std::uint64_t bytes = count_at(sizes, 3 + n, coding);
        if (bytes > stored.most()) corrupt(fmt::format("a compressed block of {} bytes is declared", bytes));
        packed_bytes += static_cast<std::size_t>(bytes);
    }
    const std::string all = stored.first(head_bytes + packed_bytes);
    std::string plain;
    for (std::size_t n = 0, at = head_bytes; n < blocks; ++n) {
        const auto bytes = static_cast<std::size_t>(count_at(sizes, 3 + n, coding));
        const bool is_last = n + 1 == blocks;
        plain +=
            inflated(std::string_view(all).substr(at, bytes), static_cast<std::size_t>(is_last && last > 0 ? last : size));
        at += bytes;
    }
    return plain;
}

std::string plain_bytes(const ArrayBytes& stored, const Coding& coding) {
    if (coding.compressed) return inflated_blocks(stored, coding);
    const std::size_t width = coding.wide_counts ? 8 : 4;
    const std::uint64_t count = count_at(stored.first(width), 0, coding);
    if (count > stored.most())
        corrupt(fmt::format("an array of {} bytes is declared where {} can be", count, stored.most()));
    return stored.first(width + static_cast<std::size_t>(count)).substr(width);
}

/// The bytes of an array that is not text.
ArrayBytes stored_bytes(const XmlTag& array, const Coding& coding) {
    if (array.attribute("format") == "binary") return {trimmed(array.text), true};
    const std::int64_t offset = integer_of(array.attribute("offset"));
    if (offset < 0 || static_cast<std::uint64_t>(offset) > coding.appended.size())
        corrupt(fmt::format("an array begins at byte {} of {} appended ones", offset, coding.appended.size()));
    return {coding.appended.substr(static_cast<std::size_t>(offset)), coding.appended_base64};
}

std::vector<double> numbers_of(const XmlTag& array, const Coding& coding) {
    std::vector<double> numbers;
    const NumberType& type = number_type(array.attribute("type"));
    const std::string_view format = array.attribute("format");
    if (format == "ascii" || format.empty()) {
        std::string_view text = array.text;
        for (auto word = take_word(text); !word.empty(); word = take_word(text)) numbers.push_back(number_of(word));
        return numbers;
    }
    if (format != "binary" && format != "appended")
        unsupported(fmt::format("arrays in the format \"{}\" are not read", format.substr(0, 40)));
    const std::string bytes = plain_bytes(stored_bytes(array, coding), coding);
    if (bytes.size() % type.bytes != 0) corrupt(fmt::format("an array of {} has {} bytes", type.name, bytes.size()));
    numbers.reserve(bytes.size() / type.bytes);
    for (std::size_t at = 0; at < bytes.size(); at += type.bytes)
        numbers.push_back(type.load(reinterpret_cast<const unsigned char*>(bytes.data()) + at, coding.big_endian));
    return numbers;
}

/// The declared number of a piece's items.
std::size_t count_of(const XmlTag& piece, std::string_view what) {
    const std::string_view text = piece.attribute(what);
    const std::int64_t count = text.empty() ? 0 : integer_of(text);
    if (count < 0) corrupt(fmt::format("{} is {}", what, count));
    return static_cast<std::size_t>(count);
}

/// Arrays of one piece's part: its points, its lines, ...
struct Part {
    std::vector<double> vectors, connectivity, offsets;
};

/// Of points or normals, as many as declared.
std::vector<Vec3> vectors_of(const std::vector<double>& xyz, std::size_t declared, std::string_view what) {
    if (xyz.size() % 3 != 0 || xyz.size() / 3 != declared)
        corrupt(fmt::format("{} {} are declared and {} coordinates are there", declared, what, xyz.size()));
    std::vector<Vec3> vectors;
    for (std::size_t n = 0; n < xyz.size(); n += 3) vectors.push_back({xyz[n], xyz[n + 1], xyz[n + 2]});
    return vectors;
}

std::size_t index_of(double value, std::size_t most, std::string_view what) {
    if (!(value >= 0 && value <= static_cast<double>(most) && value == std::floor(value)))
        corrupt(fmt::format("{} {} stands in an array; the limit is {}", what, value, most));
    return static_cast<std::size_t>(value);
}

void append_cells(const Part& part, std::size_t declared, std::size_t first_point, std::size_t points, Cells& cells) {
    if (part.offsets.size() != declared)
        corrupt(fmt::format("{} cells are declared and {} are there", declared, part.offsets.size()));
    std::size_t before = 0;
    const std::size_t begin = cells.corners.size();
    for (const double value : part.offsets) {
        const std::size_t end = index_of(value, part.connectivity.size(), "the offset");
        if (end < before) corrupt("the offsets of cells do not grow");
        cells.ends.push_back(begin + end);
        before = end;
    }
    if (before != part.connectivity.size())
        corrupt(fmt::format("the offsets of cells end at {} of {} corners", before, part.connectivity.size()));
    for (const double value : part.connectivity) {
        const std::size_t corner = index_of(value, std::numeric_limits<std::uint32_t>::max(), "the point number");
        if (corner >= points) corrupt(fmt::format("a cell refers to point {}, counted from 0, of {}", corner, points));
        cells.corners.push_back(static_cast<std::uint32_t>(first_point + corner));
    }
}

class XmlParser {
public:
    explicit XmlParser(std::string_view bytes) : bytes_(bytes) {}

    PolyData parse() {
        if (bytes_.find("<VTKFile") == std::string_view::npos) corrupt("no VTK file: there is no tag VTKFile");
        // Or a word that is cut off would look like one that is not known.
        if (bytes_.rfind("</VTKFile>") == std::string_view::npos) corrupt("the file ends amid its data");
        find_appended();
        XmlTags tags(bytes_);
        while (const auto tag = tags.next()) {
            if (tag->name == "AppendedData") break;
            take(*tag);
        }
        if (!has_root_) corrupt("no VTK file: there is no tag VTKFile");
        check_polydata(data_);
        return std::move(data_);
    }

private:
    /// Arrays refer to what stands at the file's end and need not be XML.
    void find_appended() {
        XmlTags tags(bytes_);
        while (const auto tag = tags.next()) {
            if (tag->name != "AppendedData" || !tag->opens) continue;
            const std::string_view rest = tags.rest();
            const std::size_t mark = rest.find('_');
            if (mark == std::string_view::npos) corrupt("its appended data do not begin with \"_\"");
            coding_.appended = rest.substr(mark + 1);
            coding_.appended_base64 = tag->attribute("encoding") != "raw";
            return;
        }
    }

    void take(const XmlTag& tag) {
        if (tag.name == "VTKFile") return tag.opens ? take_root(tag) : void();
        if (tag.name == "Piece") return tag.opens ? begin_piece(tag) : end_piece();
        if (tag.name == "DataArray" || tag.name == "Array") return tag.opens ? take_array(tag) : void();
        for (const std::string_view part :
             {"FieldData", "Points", "Verts", "Lines", "Strips", "Polys", "PointData", "CellData"})
            if (tag.name == part) part_ = tag.opens && !tag.is_empty ? part : "";
        if (tag.name == "PointData" && tag.opens) normals_ = tag.attribute("Normals");
    }

    void take_root(const XmlTag& tag) {
        if (const auto kind = tag.attribute("type"); kind != "PolyData")
            unsupported(fmt::format(
                "it holds the data set {}; polygonal data (PolyData) are read, as ParaView's Extract Surface makes",
                kind.substr(0, 40)));
        const std::string_view counts = tag.attribute("header_type"), packer = tag.attribute("compressor");
        coding_.big_endian = tag.attribute("byte_order") == "BigEndian";
        coding_.wide_counts = counts == "UInt64";
        coding_.compressed = !packer.empty();
        if (!packer.empty() && packer != "vtkZLibDataCompressor")
            unsupported(
                fmt::format("its arrays are compressed by {}; those by vtkZLibDataCompressor are read; save it so, or "
                            "without compression",
                            packer.substr(0, 40)));
        has_root_ = true;
    }

    void begin_piece(const XmlTag& tag) {
        piece_ = tag;
        parts_ = {};
        if (tag.is_empty) end_piece();
    }

    void end_piece() {
        const std::size_t first = data_.points.size(), declared = count_of(piece_, "NumberOfPoints");
        if (first + declared > std::numeric_limits<std::uint32_t>::max())
            throw Error(ErrorKind::too_large, fmt::format("{} points; at most 2^32 - 1 are possible", first + declared));
        append(vectors_of(parts_["Points"].vectors, declared, "points"), data_.points);
        if (const Part& of_points = parts_["PointData"]; !of_points.vectors.empty())
            append(vectors_of(of_points.vectors, declared, "normals"), data_.normals);
        append_cells(parts_["Lines"], count_of(piece_, "NumberOfLines"), first, declared, data_.lines);
        append_cells(parts_["Polys"], count_of(piece_, "NumberOfPolys"), first, declared, data_.polygons);
        append_cells(parts_["Strips"], count_of(piece_, "NumberOfStrips"), first, declared, data_.strips);
        parts_ = {};
    }

    static void append(const std::vector<Vec3>& from, std::vector<Vec3>& to) {
        to.insert(to.end(), from.begin(), from.end());
    }

    void take_array(const XmlTag& tag) {
        const std::string_view name = tag.attribute("Name");
        if (part_ == "FieldData" && name == "SPACE") return take_frame(tag);
        const bool has_vectors = part_ == "Points" || (part_ == "PointData" && !normals_.empty() && name == normals_);
        if (has_vectors) parts_[part_].vectors = numbers_of(tag, coding_);
        const bool has_cells = part_ == "Lines" || part_ == "Polys" || part_ == "Strips";
        if (has_cells && name == "connectivity") parts_[part_].connectivity = numbers_of(tag, coding_);
        if (has_cells && name == "offsets") parts_[part_].offsets = numbers_of(tag, coding_);
    }

    /// A text stands there as the numbers of its characters.
    void take_frame(const XmlTag& tag) {
        std::string text;
        if (tag.attribute("format") == "ascii") {
            std::string_view left = tag.text;
            for (auto word = take_word(left); !word.empty(); word = take_word(left)) {
                const double code = number_of(word);
                if (code > 0 && code < 128) text += static_cast<char>(code);
            }
        } else {
            text = plain_bytes(stored_bytes(tag, coding_), coding_);
            text = text.substr(0, text.find('\0'));
        }
        if (text != "LPS" && text != "RAS")
            unsupported(fmt::format("its field SPACE is \"{}\"; LPS and RAS are read", text.substr(0, 40)));
        data_.names_frame = true;
        data_.frame = text == "RAS" ? PatientFrame::ras : PatientFrame::lps;
    }

    std::string_view bytes_, part_, normals_;
    Coding coding_;
    XmlTag piece_;
    std::map<std::string_view, Part> parts_;
    bool has_root_ = false;
    PolyData data_;
};

/// Writes the elements of an array in base64, with the number of its bytes before them, a piece at a time.
class Base64Array {
public:
    Base64Array(AtomicFile& file, std::uint64_t bytes) : file_(file) { add(bytes); }

    template <class Number>
    void add(Number value) {
        std::array<unsigned char, sizeof(Number)> raw;
        store(value, /*big_endian=*/false, raw.data());
        held_.insert(held_.end(), raw.begin(), raw.end());
        constexpr std::size_t kPiece = 3 << 14;
        if (held_.size() < kPiece) return;
        file_.write(to_base64(std::span(held_).first(kPiece)));
        held_.erase(held_.begin(), held_.begin() + kPiece);
    }

    void finish() { file_.write(to_base64(held_)); }

private:
    AtomicFile& file_;
    std::vector<unsigned char> held_;
};

/// A field whose text stands there as VTK writes it: by its characters' numbers, a 0 at its end.
std::string text_field(std::string_view name, std::string_view text) {
    std::string numbers;
    for (const char c : text) numbers += fmt::format("{} ", static_cast<unsigned char>(c));
    return fmt::format("<DataArray type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}0</DataArray>\n",
                       name, numbers);
}

/// What needs no escape in an attribute.
std::string as_word(std::string text) {
    for (char& c : text)
        if (const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); !is_plain)
            c = '_';
    return text;
}

template <class Number, class Values>
void write_array(AtomicFile& file, std::string_view attributes, std::size_t count, const Values& values) {
    file.write(fmt::format("<DataArray {} format=\"binary\">", attributes));
    Base64Array array(file, count * sizeof(Number));
    values(array);
    array.finish();
    file.write("</DataArray>\n");
}

}  // namespace

PolyData parse_vtp(std::string_view bytes) { return XmlParser(bytes).parse(); }

void write_vtp(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance) {
    file.write(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n");
    file.write(text_field("SPACE", "LPS") + text_field("UNIT", "mm") + text_field("kontur", KONTUR_VERSION));
    for (const auto& [name, value] : provenance) file.write(text_field("kontur_" + as_word(name), value));
    file.write(
        fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
                    "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n<Points>\n",
                    mesh.points.size(), mesh.triangles.size()));
    const auto vectors = [&](const std::vector<Vec3>& all, auto number) {
        return [&all, number](Base64Array& array) {
            for (const Vec3& v : all)
                for (int axis = 0; axis < 3; ++axis) array.add(static_cast<decltype(number)>(v[axis]));
        };
    };
    write_array<double>(file, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", 3 * mesh.points.size(),
                        vectors(mesh.points, double{}));
    file.write("</Points>\n");
    if (!mesh.normals.empty()) {
        file.write("<PointData Normals=\"Normals\">\n");
        write_array<float>(file, "type=\"Float32\" Name=\"Normals\" NumberOfComponents=\"3\"", 3 * mesh.normals.size(),
                           vectors(mesh.normals, float{}));
        file.write("</PointData>\n");
    }
    file.write("<Polys>\n");
    write_array<std::int64_t>(file, "type=\"Int64\" Name=\"connectivity\"", 3 * mesh.triangles.size(),
                              [&](Base64Array& array) {
                                  for (const auto& triangle : mesh.triangles)
                                      for (const std::uint32_t corner : triangle)
                                          array.add(static_cast<std::int64_t>(corner));
                              });
    write_array<std::int64_t>(file, "type=\"Int64\" Name=\"offsets\"", mesh.triangles.size(), [&](Base64Array& array) {
        for (std::size_t n = 1; n <= mesh.triangles.size(); ++n) array.add(static_cast<std::int64_t>(3 * n));
    });
    file.write("</Polys>\n</Piece>\n</PolyData>\n</VTKFile>");
}

}  // namespace kontur
