// SPDX-License-Identifier: Apache-2.0
#include "files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/io/contour_json.h"
#include "kontur/io/image.h"
#include "kontur/io/markups.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

bool has_extension(const fs::path& path, std::string_view extension) {
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name.ends_with(extension);
}

bool is_mesh_name(const fs::path& path) {
    constexpr std::array kExtensions{".stl", ".ply", ".obj"};
    return std::any_of(kExtensions.begin(), kExtensions.end(), [&](const char* e) { return has_extension(path, e); });
}

bool is_markups_name(const fs::path& path) { return has_extension(path, ".mrk.json"); }

void append(ContourSet& all, ContourSet&& more) {
    const auto move_to = [](auto& target, auto& source) {
        target.insert(target.end(), std::make_move_iterator(source.begin()), std::make_move_iterator(source.end()));
    };
    if (all.name.empty()) all.name = std::move(more.name);
    move_to(all.contours, more.contours);
    move_to(all.interior, more.interior);
    move_to(all.exterior, more.exterior);
}

}  // namespace

FileKind input_kind(const fs::path& path) {
    if (has_extension(path, ".json")) return FileKind::contours;
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

LoadedContours load_contours(std::span<const fs::path> paths, const std::optional<std::string>&) {
    LoadedContours loaded;
    for (const fs::path& path : paths) {
        append(loaded.contours, is_markups_name(path) ? read_markups(path) : read_contour_json(path));
    }
    return loaded;
}

void save_contours(const fs::path& path, const ContourSet& set) {
    if (is_markups_name(path)) write_markups(path, set);
    else write_contour_json(path, set);
}

}  // namespace kontur::app
