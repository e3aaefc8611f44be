// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/io/geometry/patient_frame.h"

// What VTK's two formats of polygonal data have in common. Internal to io.
namespace kontur {

/// Lists of point numbers, one after the other.
struct Cells {
    std::vector<std::uint32_t> corners;
    std::vector<std::size_t> ends;  ///< of each cell, in `corners`

    std::size_t size() const { return ends.size(); }
    std::span<const std::uint32_t> operator[](std::size_t cell) const {
        const std::size_t begin = cell == 0 ? 0 : ends[cell - 1];
        return std::span(corners).subspan(begin, ends[cell] - begin);
    }
};

/// Points are finite, the cells' corners are among them.
struct PolyData {
    std::vector<Vec3> points;   ///< in the file's own frame, mm
    std::vector<Vec3> normals;  ///< of the points; empty where the file has none
    Cells lines, polygons, strips;
    PatientFrame frame = PatientFrame::lps;
    bool names_frame = false;  ///< by SPACE=LPS or SPACE=RAS in the title, or a field of that name
};

/// Of a whole file of VTK's legacy format (.vtk), text or binary, versions 1 to 5. Throws Error(unsupported) for other data
/// sets than POLYDATA, Error(corrupt_file), Error(too_large).
/// Source: "VTK File Formats" (Kitware), simple legacy formats.
PolyData parse_vtk(std::string_view bytes);

/// Of a whole file of VTK's XML format (.vtp): text, base64 and appended arrays, uncompressed or by zlib. Throws the same.
/// Source: "VTK File Formats" (Kitware), XML formats.
PolyData parse_vtp(std::string_view bytes);

/// By the name, else by the content. Errors name the file.
PolyData read_polydata(const std::filesystem::path& path);

/// A file of that name, or one that begins as those files do.
bool is_polydata(const std::filesystem::path& path, std::string_view head);

/// Throws Error(corrupt_file) unless all is as promised.
void check_polydata(const PolyData& data);

}  // namespace kontur
