// SPDX-License-Identifier: Apache-2.0
#include "files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/io/image.h"
#include "kontur/io/rtstruct.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

bool is_mesh_name(const fs::path& path) {
    constexpr std::array kExtensions{".stl", ".ply", ".obj"};
    return std::any_of(kExtensions.begin(), kExtensions.end(), [&](const char* e) { return has_extension(path, e); });
}

}  // namespace

bool has_extension(const fs::path& path, std::string_view extension) {
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name.ends_with(extension);
}

FileKind input_kind(const fs::path& path) {
    if (has_extension(path, ".json") || is_rtstruct(path)) return FileKind::contours;
    if (is_mesh_name(path)) return FileKind::mesh;
    return FileKind::image;
}

FileKind output_kind(const fs::path& path) {
    if (has_extension(path, ".json")) return FileKind::contours;
    if (is_mesh_name(path)) return FileKind::mesh;
    check_image_name(path);
    return FileKind::image;
}

void check_output_kind(const fs::path& path, FileKind kind) {
    if (kind == FileKind::image) check_image_name(path);
    else if (input_kind(path) != kind)
        throw Error(ErrorKind::unsupported,
                    fmt::format("{} is no name for {}", path.string(),
                                kind == FileKind::mesh ? "a mesh; it ends with .stl, .ply or .obj"
                                                       : "contours; it ends with .json or .mrk.json"));
}

LoadedImage load_image(const ImageInput& input, const Progress& progress) {
    if (!looks_like_dicom(input.path)) return {read_image(input.path, input.file), {}};
    DicomVolume volume = read_dicom_series(input.path, input.series, progress);
    return {std::move(volume.image), std::move(volume.notes)};
}

LoadedGrid load_grid(const ImageInput& input, const Progress& progress) {
    if (!looks_like_dicom(input.path)) return {read_grid(input.path, input.file), {}};
    DicomGrid grid = read_dicom_grid(input.path, input.series, progress);
    return {grid.grid, std::move(grid.notes)};
}

}  // namespace kontur::app
