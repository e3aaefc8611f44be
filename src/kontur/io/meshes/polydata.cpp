// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/meshes/polydata.h"

#include <fmt/format.h>

#include <limits>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/meshes/mesh_formats.h"

namespace kontur {
namespace {

constexpr std::string_view kLegacyMark = "# vtk DataFile", kXmlMark = "<VTKFile";

void check_cells(const Cells& cells, std::size_t points, std::string_view what) {
    for (const std::uint32_t corner : cells.corners)
        if (corner >= points)
            throw Error(ErrorKind::corrupt_file,
                        fmt::format("a {} refers to point {}, counted from 0, of {}", what, corner, points));
}

bool is_xml(std::string_view head) { return head.find(kXmlMark) != std::string_view::npos; }

}  // namespace

void check_polydata(const PolyData& data) {
    for (std::size_t n = 0; n < data.points.size(); ++n)
        if (!is_finite(data.points[n])) throw Error(ErrorKind::corrupt_file, fmt::format("point {} is not finite", n + 1));
    if (!data.normals.empty() && data.normals.size() != data.points.size())
        throw Error(ErrorKind::corrupt_file,
                    fmt::format("it has {} normals for {} points", data.normals.size(), data.points.size()));
    check_cells(data.lines, data.points.size(), "line");
    check_cells(data.polygons, data.points.size(), "polygon");
    check_cells(data.strips, data.points.size(), "strip");
}

bool is_polydata(const std::filesystem::path& path, std::string_view head) {
    const std::string extension = lower_case(path.extension().string());
    return extension == ".vtk" || extension == ".vtp" || head.starts_with(kLegacyMark) || is_xml(head);
}

PolyData read_polydata(const std::filesystem::path& path) {
    InputFile file(path);
    std::string bytes(file.stored_bytes_left(), '\0');
    file.read(bytes.data(), bytes.size());
    try {
        constexpr std::size_t kHeadBytes = 132;
        return is_xml(std::string_view(bytes).substr(0, kHeadBytes)) ? parse_vtp(bytes) : parse_vtk(bytes);
    } catch (const Error& error) {
        throw error.with_context(path.string());
    }
}

namespace {

/// Triangles of all polygons and strips.
TriangleMesh to_mesh(const PolyData& data) {
    TriangleMesh mesh;
    mesh.points.reserve(data.points.size());
    for (const Vec3& p : data.points) mesh.points.push_back(to_lps(data.frame, p));
    for (const Vec3& n : data.normals) mesh.normals.push_back(to_lps(data.frame, n));
    for (std::size_t cell = 0; cell < data.polygons.size(); ++cell) {
        const auto corners = data.polygons[cell];
        if (corners.size() < 3)
            throw Error(ErrorKind::corrupt_file,
                        fmt::format("polygon {} has {} corners; at least 3 are needed", cell + 1, corners.size()));
        append_polygon(mesh, {corners.begin(), corners.end()});
    }
    for (std::size_t cell = 0; cell < data.strips.size(); ++cell) {
        const auto corners = data.strips[cell];
        for (std::size_t i = 2; i < corners.size(); ++i) {
            const bool turned = i % 2 == 1;  // every other triangle of a strip runs the other way
            mesh.triangles.push_back({corners[i - 2], corners[turned ? i : i - 1], corners[turned ? i - 1 : i]});
        }
    }
    if (mesh.triangles.empty() && data.lines.size() > 0)
        throw Error(ErrorKind::unsupported,
                    fmt::format("it holds {} lines and no polygons: contours, and no mesh; kontur segment makes one of them",
                                data.lines.size()));
    return mesh;
}

}  // namespace

TriangleMesh parse_vtk_mesh(std::string_view bytes) { return to_mesh(parse_vtk(bytes)); }
TriangleMesh parse_vtp_mesh(std::string_view bytes) { return to_mesh(parse_vtp(bytes)); }

}  // namespace kontur
