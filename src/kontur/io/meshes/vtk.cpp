// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/byte_order.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/meshes/mesh_formats.h"
#include "kontur/io/meshes/polydata.h"

namespace kontur {
namespace {

constexpr std::size_t kMostTitle = 255;

[[noreturn]] void corrupt(const std::string& reason) { throw Error(ErrorKind::corrupt_file, reason); }

enum class Number { int8, uint8, int16, uint16, int32, uint32, int64, float32, float64 };

struct NumberName {
    std::string_view name;
    Number type;
};
/// Not "long", whose size depends on the machine that wrote it.
constexpr std::array kNumbers{NumberName{"char", Number::int8},
                              NumberName{"signed_char", Number::int8},
                              NumberName{"unsigned_char", Number::uint8},
                              NumberName{"short", Number::int16},
                              NumberName{"unsigned_short", Number::uint16},
                              NumberName{"int", Number::int32},
                              NumberName{"vtkidtype", Number::int32},
                              NumberName{"vtktypeint32", Number::int32},
                              NumberName{"unsigned_int", Number::uint32},
                              NumberName{"vtktypeint64", Number::int64},
                              NumberName{"float", Number::float32},
                              NumberName{"double", Number::float64}};

Number number_type(std::string_view word) {
    const std::string small = lower_case(std::string(word));
    for (const NumberName& known : kNumbers)
        if (known.name == small) return known.type;
    throw Error(ErrorKind::unsupported, fmt::format("numbers of type \"{}\" are not read", word.substr(0, 40)));
}

std::size_t size_of(Number type) {
    constexpr std::array<std::size_t, 9> kSizes{1, 1, 2, 2, 4, 4, 8, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

class LegacyParser {
public:
    explicit LegacyParser(std::string_view bytes) : left_(bytes) {}

    PolyData parse() {
        try {
            read_head();
            while (next_keyword())
                if (!read_section()) break;
        } catch (const Error& error) {
            // A word that is cut off looks like one that is not known.
            if (error.kind() == ErrorKind::unsupported && left_.empty()) corrupt("the file ends amid its header");
            throw;
        }
        if (!has_points_ || !has_cells_) corrupt(has_points_ ? "it ends behind its points" : "it ends before its points");
        check_polydata(data_);
        return std::move(data_);
    }

private:
    void read_head() {
        const std::string_view version = take_line(left_);
        if (!version.starts_with("# vtk DataFile Version "))
            corrupt("no VTK file: the first line does not begin with \"# vtk DataFile Version\"");
        const std::string_view title = take_line(left_);
        data_.names_frame =
            title.find("SPACE=LPS") != std::string_view::npos || title.find("SPACE=RAS") != std::string_view::npos;
        data_.frame = declared_frame(title, PatientFrame::lps);
        const std::string coding = lower_case(std::string(trimmed(take_line(left_))));
        if (coding != "ascii" && coding != "binary")
            corrupt(fmt::format("\"{}\" stands where ASCII or BINARY is needed", coding));
        binary_ = coding == "binary";
        const std::string head(version.substr(version.find("Version ") + 8));
        is_version_5_ = head.starts_with("5") || head.starts_with("6");
    }

    /// Reads the next line that is not empty into `line_`, its first word in capitals into `keyword_`.
    bool next_keyword() {
        left_.remove_prefix(std::min(left_.find_first_not_of(" \t\r\n"), left_.size()));
        if (left_.empty()) return false;
        line_ = take_line(left_);
        keyword_ = std::string(take_word(line_));
        for (char& c : keyword_) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
        return true;
    }

    /// False at attributes that mean nothing here, behind which nothing else follows.
    bool read_section() {
        if (keyword_ == "POINT_DATA") return read_normals();
        if (keyword_ == "CELL_DATA") return false;
        if (keyword_ == "DATASET") check_dataset();
        else if (keyword_ == "POINTS") read_points();
        else if (keyword_ == "VERTICES") read_cells();
        else if (keyword_ == "LINES") append(read_cells(), data_.lines);
        else if (keyword_ == "POLYGONS") append(read_cells(), data_.polygons);
        else if (keyword_ == "TRIANGLE_STRIPS") append(read_cells(), data_.strips);
        else if (keyword_ == "FIELD") skip_field();
        else if (keyword_ == "METADATA") skip_metadata();
        else corrupt(fmt::format("\"{}\" stands where a part of the data set is needed", keyword_.substr(0, 40)));
        return true;
    }

    void check_dataset() {
        const std::string_view kind = take_word(line_);
        if (lower_case(std::string(kind)) != "polydata")
            throw Error(
                ErrorKind::unsupported,
                fmt::format(
                    "it holds the data set {}; polygonal data (POLYDATA) are read, as ParaView's Extract Surface makes",
                    kind.substr(0, 40)));
    }

    std::size_t take_count() {
        const std::int64_t count = integer_of(take_word(line_));
        if (count < 0) corrupt(fmt::format("{} declares {} items", keyword_, count));
        return static_cast<std::size_t>(count);
    }

    /// Refuses what the rest of the file cannot hold; in text a number is a digit and a blank, but for the last.
    void expect(std::size_t count, std::size_t bytes_each) const {
        const std::size_t most = binary_ ? left_.size() / bytes_each : (left_.size() + 1) / 2;
        if (count > most) corrupt(fmt::format("{} declares {} numbers, but {} bytes follow", keyword_, count, left_.size()));
    }

    double next_number(Number type) {
        if (!binary_) return number_of(take_word(left_));
        if (left_.size() < size_of(type)) corrupt("the file ends amid its data");
        const auto* raw = reinterpret_cast<const unsigned char*>(left_.data());
        left_.remove_prefix(size_of(type));
        switch (type) {
            case Number::int8:
                return load<std::int8_t>(raw, kBigEndian);
            case Number::uint8:
                return load<std::uint8_t>(raw, kBigEndian);
            case Number::int16:
                return load<std::int16_t>(raw, kBigEndian);
            case Number::uint16:
                return load<std::uint16_t>(raw, kBigEndian);
            case Number::int32:
                return load<std::int32_t>(raw, kBigEndian);
            case Number::uint32:
                return load<std::uint32_t>(raw, kBigEndian);
            case Number::int64:
                return static_cast<double>(load<std::int64_t>(raw, kBigEndian));
            case Number::float32:
                return load<float>(raw, kBigEndian);
            default:
                return load<double>(raw, kBigEndian);
        }
    }

    /// A whole number from 0 that is no more than `most`.
    std::size_t next_index(Number type, std::size_t most, std::string_view what) {
        const double index = next_number(type);
        if (!(index >= 0 && index <= static_cast<double>(most) && index == std::floor(index)))
            corrupt(fmt::format("{} {} stands in {}; the limit is {}", what, index, keyword_, most));
        return static_cast<std::size_t>(index);
    }

    void read_points() {
        const std::size_t count = take_count();
        const Number type = number_type(take_word(line_));
        if (!data_.points.empty()) corrupt("it has its points twice");
        if (count > std::numeric_limits<std::uint32_t>::max())
            throw Error(ErrorKind::too_large, fmt::format("{} points; at most 2^32 - 1 are possible", count));
        expect(3 * count, size_of(type));
        data_.points = read_vectors(count, type);
        has_points_ = true;
    }

    /// The first attribute of the points, if it is that.
    bool read_normals() {
        const std::size_t count = take_count();
        if (!next_keyword() || keyword_ != "NORMALS") return false;
        take_word(line_);
        const Number type = number_type(take_word(line_));
        if (count != data_.points.size())
            corrupt(fmt::format("{} normals are declared for {} points", count, data_.points.size()));
        expect(3 * count, size_of(type));
        data_.normals = read_vectors(count, type);
        return false;
    }

    std::vector<Vec3> read_vectors(std::size_t count, Number type) {
        std::vector<Vec3> vectors;
        vectors.reserve(count);
        for (std::size_t n = 0; n < count; ++n) {
            const double x = next_number(type), y = next_number(type);
            vectors.push_back({x, y, next_number(type)});
        }
        return vectors;
    }

    Cells read_cells() {
        has_cells_ = true;
        return is_version_5_ ? read_cells_by_offsets() : read_counted_cells();
    }

    /// "n size", then for each cell its number of corners and these.
    Cells read_counted_cells() {
        const std::size_t count = take_count(), numbers = take_count();
        expect(numbers, size_of(Number::int32));
        if (count > numbers) corrupt(fmt::format("{} declares {} cells of {} numbers", keyword_, count, numbers));
        Cells cells;
        std::size_t left = numbers;
        for (std::size_t cell = 0; cell < count; ++cell) {
            if (left == 0) corrupt(fmt::format("{} declares more cells than numbers", keyword_));
            const std::size_t corners = next_index(Number::int32, --left, "a number of corners");
            for (std::size_t n = 0; n < corners; ++n) cells.corners.push_back(next_corner(Number::int32));
            cells.ends.push_back(cells.corners.size());
            left -= corners;
        }
        if (left != 0) corrupt(fmt::format("{} declares {} numbers more than its cells have", keyword_, left));
        return cells;
    }

    /// "n + 1, corners", then where each cell begins and all corners.
    Cells read_cells_by_offsets() {
        const std::size_t offsets = take_count(), corners = take_count();
        const std::string section = keyword_;
        const Number offset_type = array_type("OFFSETS");
        keyword_ = section;
        expect(offsets, size_of(offset_type));
        Cells cells;
        std::size_t before = 0;
        for (std::size_t n = 0; n < offsets; ++n) {
            const std::size_t offset = next_index(offset_type, corners, "an offset");
            if (offset < before || (n == 0 && offset != 0))
                corrupt(fmt::format("the offsets of {} do not grow from 0", section));
            if (n > 0) cells.ends.push_back(offset);
            before = offset;
        }
        if (before != corners) corrupt(fmt::format("the offsets of {} end at {} of {} corners", section, before, corners));
        const Number corner_type = array_type("CONNECTIVITY");
        keyword_ = section;
        expect(corners, size_of(corner_type));
        for (std::size_t n = 0; n < corners; ++n) cells.corners.push_back(next_corner(corner_type));
        return cells;
    }

    std::uint32_t next_corner(Number type) {
        return static_cast<std::uint32_t>(next_index(type, std::numeric_limits<std::uint32_t>::max(), "the point number"));
    }

    Number array_type(std::string_view name) {
        if (!next_keyword() || keyword_ != name) corrupt(fmt::format("{} is missing", name));
        return number_type(take_word(line_));
    }

    static void append(Cells cells, Cells& to) {
        if (!to.ends.empty()) corrupt("it has cells of one kind twice");
        to = std::move(cells);
    }

    /// "name arrays", then for each its name, components, tuples and type.
    void skip_field() {
        take_word(line_);
        for (std::size_t arrays = take_count(); arrays > 0; --arrays) {
            if (!next_keyword()) corrupt("the file ends amid its fields");
            if (keyword_ == "METADATA") skip_metadata(), next_keyword();
            const std::size_t components = take_count(), tuples = take_count();
            const Number type = number_type(take_word(line_));
            expect(components, size_of(type));
            expect(tuples, size_of(type));
            std::size_t numbers = 0;
            if (__builtin_mul_overflow(components, tuples, &numbers)) corrupt("a field declares more numbers than can be");
            expect(numbers, size_of(type));
            for (std::size_t n = 0; n < numbers; ++n) next_number(type);
        }
    }

    /// To the next empty line.
    void skip_metadata() {
        while (!left_.empty() && !trimmed(take_line(left_)).empty()) {
        }
    }

    std::string_view left_, line_;
    std::string keyword_;
    bool binary_ = false, is_version_5_ = false, has_points_ = false, has_cells_ = false;
    PolyData data_;
};

template <class Number>
void append(std::string& bytes, Number value) {
    std::array<unsigned char, sizeof(Number)> raw;
    store(value, kBigEndian, raw.data());
    bytes.append(reinterpret_cast<const char*>(raw.data()), raw.size());
}

}  // namespace

void write_vtk(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance) {
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max() / 4;
    if (std::max(mesh.points.size(), mesh.triangles.size()) > kMost)
        throw Error(ErrorKind::too_large,
                    fmt::format("{} points and {} triangles; VTK's legacy format holds at most {} of each",
                                mesh.points.size(), mesh.triangles.size(), kMost));
    std::string title = fmt::format("kontur {} SPACE=LPS UNIT=mm", KONTUR_VERSION);
    if (!provenance.empty()) title.append(" ").append(short_text(provenance, kMostTitle - title.size() - 1));
    title = printable_utf8(title);  // one line
    file.write(fmt::format("# vtk DataFile Version 3.0\n{}\nBINARY\nDATASET POLYDATA\nPOINTS {} double\n", title,
                           mesh.points.size()));
    for (const Vec3& p : mesh.points) {
        std::string row;
        for (int axis = 0; axis < 3; ++axis) append(row, p[axis]);
        file.write(row);
    }
    file.write(fmt::format("\nPOLYGONS {} {}\n", mesh.triangles.size(), 4 * mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
        std::string row;
        append(row, std::int32_t{3});
        for (const std::uint32_t corner : triangle) append(row, static_cast<std::int32_t>(corner));
        file.write(row);
    }
    if (mesh.normals.empty()) return;
    file.write(fmt::format("\nPOINT_DATA {}\nNORMALS normals float\n", mesh.points.size()));
    for (const Vec3& normal : mesh.normals) {
        std::string row;
        for (int axis = 0; axis < 3; ++axis) append(row, static_cast<float>(normal[axis]));
        file.write(row);
    }
}

PolyData parse_vtk(std::string_view bytes) { return LegacyParser(bytes).parse(); }

}  // namespace kontur
