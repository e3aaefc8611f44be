// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/meshes/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "kontur/base/error.h"
#include "kontur/base/number_from_chars.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/meshes/mesh_formats.h"

namespace kontur {
namespace {

struct Format {
    std::string_view extension;
    void (*write)(AtomicFile&, const TriangleMesh&, const Provenance&);
    TriangleMesh (*parse)(std::string_view);
};

constexpr std::array kFormats{Format{".stl", write_stl, parse_stl}, Format{".ply", write_ply, parse_ply},
                              Format{".obj", write_obj, parse_obj}, Format{".vtk", write_vtk, parse_vtk_mesh},
                              Format{".vtp", write_vtp, parse_vtp_mesh}};

const Format& format_of(const std::filesystem::path& path) {
    const std::string extension = lower_case(path.extension().string());
    const auto format =
        std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.extension == extension; });
    if (format == kFormats.end())
        throw Error(
            ErrorKind::unsupported,
            fmt::format("{}: a mesh file ends in .stl, .ply, .obj, .vtk or .vtp, not in \"{}\"", path.string(), extension));
    return *format;
}

template <class Number>
Number parsed(std::string_view word, const char* what) {
    Number value{};
    const char* begin = word.data() + (word.size() > 1 && word.front() == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    const auto [stop, status] = number_from_chars(begin, end, value);
    if (status != std::errc() || stop != end)
        throw Error(ErrorKind::corrupt_file, fmt::format("\"{}\" stands where {} is needed", word.substr(0, 40), what));
    return value;
}

}  // namespace

PatientFrame declared_frame(std::string_view text, PatientFrame otherwise) {
    if (text.find("SPACE=RAS") != std::string_view::npos) return PatientFrame::ras;
    if (text.find("SPACE=LPS") != std::string_view::npos) return PatientFrame::lps;
    return otherwise;
}

void append_polygon(TriangleMesh& mesh, const std::vector<std::uint32_t>& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

std::string_view take_word(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    return word;
}

std::string_view take_line(std::string_view& text) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

double number_of(std::string_view word) {
    const auto value = parsed<double>(word, "a number");
    if (!std::isfinite(value))
        throw Error(ErrorKind::corrupt_file, fmt::format("\"{}\" stands where a finite number is needed", word));
    return value;
}

std::int64_t integer_of(std::string_view word) { return parsed<std::int64_t>(word, "an integer"); }

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const Provenance& provenance) {
    const Format& format = format_of(path);
    check_mesh(mesh);
    write_file_atomically(path, [&](AtomicFile& file) { format.write(file, mesh, provenance); });
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const PointValues& values,
                const Provenance& provenance) {
    if (format_of(path).parse != parse_ply)
        throw Error(ErrorKind::unsupported, fmt::format("{}: only a .ply has room for {}", path.string(), values.name));
    check_mesh(mesh);
    if (values.values.size() != mesh.points.size())
        throw Error(ErrorKind::invalid_input, fmt::format("{} has {} values for the {} points of the mesh", values.name,
                                                          values.values.size(), mesh.points.size()));
    write_file_atomically(path, [&](AtomicFile& file) { write_ply(file, mesh, {.values = &values}, provenance); });
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
    const Format& format = format_of(path);
    InputFile file(path);
    std::string bytes(file.stored_bytes_left(), '\0');
    file.read(bytes.data(), bytes.size());
    try {
        return format.parse(bytes);
    } catch (const Error& error) {
        throw error.with_context(path.string());
    }
}

}  // namespace kontur
