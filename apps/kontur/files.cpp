// SPDX-License-Identifier: Apache-2.0
#include "files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/contours/vtk_contours.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

void check_mask_name(const fs::path& path) {
    try {
        check_image_name(path);
    } catch (const Error& error) {
        throw Error(error.kind(), std::string(error.what()) + ", and for masks .dcm (SEG)");
    }
}

bool is_mesh_name(const fs::path& path) {
    constexpr std::array kExtensions{".stl", ".ply", ".obj", ".vtk", ".vtp"};
    return std::any_of(kExtensions.begin(), kExtensions.end(), [&](const char* e) { return has_extension(path, e); });
}

/// Such a file holds contours or a mesh.
bool is_vtk_name(const fs::path& path) { return has_extension(path, ".vtk") || has_extension(path, ".vtp"); }

}  // namespace

bool has_extension(const fs::path& path, std::string_view extension) {
    return lower_case(path.filename().string()).ends_with(extension);
}

FileKind input_kind(const fs::path& path) {
    if (has_extension(path, ".json") || is_rtstruct(path)) return FileKind::contours;
    if (is_mesh_name(path)) return is_vtk_name(path) && has_vtk_lines(path) ? FileKind::contours : FileKind::mesh;
    return FileKind::image;
}

bool is_dicom_slice(const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored) || !looks_like_dicom(path)) return false;
    try {
        return !is_dicom_seg(path) && !is_rtstruct(path);
    } catch (const Error&) {
        return true;
    }
}

fs::path series_folder(const fs::path& input) {
    std::error_code ignored;
    if (fs::is_directory(input, ignored)) return input;
    return is_dicom_slice(input) ? fs::absolute(input).parent_path() : fs::path();
}

bool is_within(const fs::path& path, const fs::path& folder) {
    std::error_code ignored;
    fs::path above = fs::weakly_canonical(fs::absolute(path), ignored);
    for (; above != above.parent_path(); above = above.parent_path())
        if (fs::equivalent(above, folder, ignored)) return true;
    return fs::equivalent(above, folder, ignored);
}

bool is_dicom_name(const fs::path& path) { return has_extension(path, ".dcm"); }

void refuse_images(const std::vector<fs::path>& contours) {
    constexpr std::array kExtensions{".nii", ".nii.gz", ".nrrd", ".mha", ".mhd", ".mgz", ".mgh"};
    for (const fs::path& path : contours) {
        std::error_code ignored;
        const bool is_folder = fs::is_directory(path, ignored);
        const bool is_named_so =
            std::any_of(kExtensions.begin(), kExtensions.end(), [&](const char* e) { return has_extension(path, e); });
        if (is_folder || is_named_so || is_dicom_slice(path))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} is {}, not a file of contours; an image goes behind --image", path.string(),
                                    is_folder ? "a folder" : "an image"));
    }
}

std::optional<FileKind> output_kind(const fs::path& path) {
    if (is_dicom_name(path)) return std::nullopt;
    if (has_extension(path, ".json")) return FileKind::contours;
    if (is_mesh_name(path)) return FileKind::mesh;
    check_mask_name(path);
    return FileKind::image;
}

void check_output_kind(const fs::path& path, FileKind kind) {
    const auto refuse = [&](const char* what) {
        throw Error(ErrorKind::unsupported, fmt::format("{} is no name for {}", path.string(), what));
    };
    if (kind == FileKind::image && !is_dicom_name(path)) check_mask_name(path);
    else if (kind == FileKind::mesh && !is_mesh_name(path)) refuse("a mesh; it ends with .stl, .ply, .obj, .vtk or .vtp");
    else if (kind == FileKind::contours && !has_extension(path, ".json") && !is_dicom_name(path))
        refuse("contours; it ends with .json, .mrk.json or .dcm");
}

}  // namespace kontur::app
