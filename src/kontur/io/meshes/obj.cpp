// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <limits>
#include <optional>

#include "kontur/base/error.h"
#include "kontur/io/meshes/mesh_formats.h"

namespace kontur {
namespace {

/// The file's numbered lists and the mesh that grows from them.
class ObjParser {
public:
    TriangleMesh parse(std::string_view text) {
        for (; !text.empty(); ++line_) {
            std::string_view line = take_line(text);
            try {
                parse_line(line);
            } catch (const Error& error) {
                throw error.with_context(fmt::format("line {}", line_));
            }
        }
        if (mesh_.points.size() > std::numeric_limits<std::uint32_t>::max())
            throw Error(ErrorKind::too_large, fmt::format("{} points; at most 2^32 - 1 are possible", mesh_.points.size()));
        return in_lps();
    }

private:
    void parse_line(std::string_view line) {
        if (line.starts_with('#')) {
            frame_ = declared_frame(line, frame_);
            return;
        }
        const std::string_view keyword = take_word(line);
        if (keyword == "v") {
            mesh_.points.push_back(vector_of(line));
            normal_of_point_.emplace_back();
        } else if (keyword == "vn") {
            normals_.push_back(vector_of(line));
        } else if (keyword == "f") {
            parse_face(line);
        }
    }

    static Vec3 vector_of(std::string_view line) {
        const double x = number_of(take_word(line)), y = number_of(take_word(line));
        return {x, y, number_of(take_word(line))};
    }

    void parse_face(std::string_view line) {
        std::vector<std::uint32_t> corners;
        for (auto word = take_word(line); !word.empty(); word = take_word(line)) corners.push_back(parse_corner(word));
        if (corners.size() < 3)
            throw Error(ErrorKind::corrupt_file,
                        fmt::format("a face with {} corners; at least 3 are needed", corners.size()));
        append_polygon(mesh_, corners);
    }

    /// "point", "point/texture", "point/texture/normal" or "point//normal".
    std::uint32_t parse_corner(std::string_view word) {
        const auto slash = word.find('/'), last_slash = word.rfind('/');
        const auto point = static_cast<std::uint32_t>(index_of(word.substr(0, slash), mesh_.points.size(), "point"));
        std::optional<std::size_t> normal;
        if (slash != last_slash) normal = index_of(word.substr(last_slash + 1), normals_.size(), "normal");
        if (!normal || (normal_of_point_[point] && normal_of_point_[point] != normal)) one_normal_per_point_ = false;
        normal_of_point_[point] = normal;
        return point;
    }

    /// Counted from 1, or from the end of what has been listed so far if negative.
    static std::size_t index_of(std::string_view word, std::size_t count, const char* what) {
        const std::int64_t number = integer_of(word), size = static_cast<std::int64_t>(count);
        if (number == 0 || number > size || number < -size)
            throw Error(ErrorKind::corrupt_file, fmt::format("a face refers to {} {} of {}", what, number, count));
        return static_cast<std::size_t>(number > 0 ? number - 1 : size + number);
    }

    TriangleMesh in_lps() {
        for (Vec3& p : mesh_.points) p = to_lps(frame_, p);
        if (one_normal_per_point_ && !normals_.empty())
            for (const auto& normal : normal_of_point_)
                mesh_.normals.push_back(normal ? to_lps(frame_, normals_[*normal]) : Vec3{});
        return std::move(mesh_);
    }

    TriangleMesh mesh_;
    std::vector<Vec3> normals_;
    std::vector<std::optional<std::size_t>> normal_of_point_;
    bool one_normal_per_point_ = true;
    PatientFrame frame_ = PatientFrame::lps;
    std::uint64_t line_ = 1;
};

}  // namespace

void write_obj(AtomicFile& file, const TriangleMesh& mesh, const Provenance& provenance) {
    file.write(fmt::format("# kontur {}\n# SPACE=LPS\n# UNIT=mm\n", KONTUR_VERSION));
    for (const auto& [name, value] : provenance) file.write(fmt::format("# kontur {}: {}\n", name, value));
    for (const Vec3& p : mesh.points) file.write(fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z));
    for (const Vec3& n : mesh.normals) file.write(fmt::format("vn {:.6f} {:.6f} {:.6f}\n", n.x, n.y, n.z));
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint64_t i = a + 1ull, j = b + 1ull, k = c + 1ull;
        file.write(mesh.normals.empty() ? fmt::format("f {} {} {}\n", i, j, k)
                                        : fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", i, j, k));
    }
}

TriangleMesh parse_obj(std::string_view bytes) { return ObjParser().parse(bytes); }

}  // namespace kontur
