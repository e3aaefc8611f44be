// SPDX-License-Identifier: Apache-2.0
#include "files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "kontur/base/error.h"
#include "kontur/io/contours.h"
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

bool is_dicom_name(const fs::path& path) { return has_extension(path, ".dcm"); }

std::optional<FileKind> output_kind(const fs::path& path) {
    if (is_dicom_name(path)) return std::nullopt;
    if (has_extension(path, ".json")) return FileKind::contours;
    if (is_mesh_name(path)) return FileKind::mesh;
    check_image_name(path);
    return FileKind::image;
}

void check_output_kind(const fs::path& path, FileKind kind) {
    const auto refuse = [&](const char* what) {
        throw Error(ErrorKind::unsupported, fmt::format("{} is no name for {}", path.string(), what));
    };
    if (kind == FileKind::image) check_image_name(path);
    else if (kind == FileKind::mesh && !is_mesh_name(path)) refuse("a mesh; it ends with .stl, .ply or .obj");
    else if (kind == FileKind::contours && !has_extension(path, ".json") && !is_dicom_name(path))
        refuse("contours; it ends with .json, .mrk.json or .dcm");
}

std::vector<std::string> write_contours(const fs::path& path, const ContourSet& set, const ImageInput& images,
                                        const WriteRtstructOptions& options) {
    if (!is_dicom_name(path)) {
        write_contours(path, set);
        return {};
    }
    Roi roi;
    roi.name = set.name;
    roi.color = {230, 180, 80};
    roi.generation_algorithm = "SEMIAUTOMATIC";
    roi.contours = set;
    return write_rtstruct(path, {"kontur", {roi}}, read_dicom_grid(images.path, images.options.dicom).series, options);
}

void check_dicom_images(const fs::path& output, const fs::path& images) {
    if (!is_dicom_name(output)) return;
    if (images.empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} would refer to the DICOM images it was made on; give their folder with --image",
                                output.string()));
    if (!looks_like_dicom(images))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} is no DICOM series, to which {} could refer", images.string(), output.string()));
}

}  // namespace kontur::app
