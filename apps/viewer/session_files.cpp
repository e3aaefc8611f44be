// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/extract/trace.h"
#include "kontur/io/atomic_file.h"
#include "kontur/io/contours.h"
#include "kontur/io/image.h"
#include "kontur/io/mesh.h"
#include "kontur/io/png.h"
#include "kontur/segment.h"
#include "kontur/view/picture.h"
#include "viewer/session.h"
#include "viewer/temporary_files.h"

// What leaves the session as files and comes in as files.

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::array kMasks{"mask.nii.gz", "mask.nii", "mask.nrrd", "mask.seg.nrrd", "mask.mha"};
constexpr std::array kMeshes{"mesh.stl", "mesh.ply", "mesh.obj"};
constexpr std::array kContours{"contours.json", "contours.mrk.json"};

/// Traced contours keep what matters of a mask at a tenth of a millimetre; smaller sections are specks.
constexpr TraceOptions kTraceOptions{.step_mm = 0, .tolerance_mm = 0.1, .min_area_mm2 = 4, .threads = 0};
constexpr std::size_t kMostImportedLabels = 64;

template <class Names>
bool is_one_of(const std::string& name, const Names& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::array<double, 3> rgb(const std::string& color) {
    std::array<double, 3> parts{};
    for (std::size_t i = 0; i < 3; ++i) parts[i] = std::stoi(color.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
    return parts;
}

/// A file name without what any system or header would stumble over.
std::string file_name(const std::string& structure, const std::string& kind) {
    std::string name;
    for (const char c : structure) {
        const bool plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
        name += plain ? c : '_';
    }
    return (name.empty() ? "structure" : name) + kind.substr(kind.find('.'));
}

void write_mask_file(const fs::path& path, const ContourSet& set, const Structure& structure, const Grid& grid) {
    WriteMaskOptions options;
    options.segment_name = structure.name;
    options.segment_color = rgb(structure.color);
    const Segmentation made = segment(set, grid);
    options.provenance = provenance(set, grid, made.report);
    write_mask(path, made.mask, options);
}

Segmentation segmented(const ContourSet& set, const Grid& grid) {
    SegmentOptions options;
    options.mesh = true;
    return segment(set, grid, options);
}

void write_mesh_file(const fs::path& path, const ContourSet& set, const Grid& grid) {
    const Segmentation made = segmented(set, grid);
    write_mesh(path, *made.mesh, provenance(set, grid, made.report));
}

void write_picture(const fs::path& path, const ContourSet& set, const Image& image) {
    const Segmentation made = segmented(set, image.grid);
    PictureOptions options;
    options.facts = {{"Residual (max)", fmt::format("{:.2g} mm", made.report.residual.max_mm)},
                     {"Residual (rms)", fmt::format("{:.2g} mm", made.report.residual.rms_mm)}};
    write_png(path, make_picture(*made.mesh, set, &image, options));
}

/// Bytes as the library's readers take them: a file whose name tells its format.
fs::path stored(const TemporaryFolder& folder, const std::string& bytes, const std::string& extension) {
    const fs::path path = folder.path() / ("upload" + extension);
    write_file_atomically(path, bytes);
    return path;
}

/// The reader's sentence without the temporary name, which the user never gave.
template <class Read>
auto reading(const fs::path& path, Read read) {
    try {
        return read();
    } catch (const Error& error) {
        std::string sentence = error.what();
        for (std::size_t at; (at = sentence.find(path.string())) != std::string::npos;)
            sentence.replace(at, path.string().size(), "the file");
        throw Error(error.kind(), sentence);
    }
}

/// Planes across `kind`, spread evenly over the mask's extent; a mask has half a step of room beyond the outermost ones.
std::vector<Plane> planes_across(const Mask& mask, SliceKind kind, int count) {
    View view = view_of(mask.grid, kind);
    double from = std::numeric_limits<double>::infinity(), to = -from;
    const Index3& n = mask.grid.size;
    for (std::int64_t k = 0; k < n.k; ++k)
        for (std::int64_t j = 0; j < n.j; ++j)
            for (std::int64_t i = 0; i < n.i; ++i)
                if (mask.values[mask.grid.offset(i, j, k)]) {
                    const double at = view.plane.distance_to(mask.grid.center_mm(i, j, k));
                    from = std::min(from, at), to = std::max(to, at);
                }
    std::vector<Plane> planes;
    for (int i = 0; i < count; ++i) {
        // On the mask's own slices, where its border is not interpolated, and each of them once.
        const double at = from + (to - from) * (i + 0.5) / count;
        Plane plane = view.plane;
        plane.origin += std::round(at / view.step_mm) * view.step_mm * plane.normal;
        if (planes.empty() || distance(planes.back().origin, plane.origin) > 0.5 * view.step_mm) planes.push_back(plane);
    }
    return planes;
}

ContourSet traced(const Mask& mask, const Session::TraceRequest& request) {
    std::vector<Plane> planes;
    const auto add = [&](bool wanted, SliceKind kind) {
        if (!wanted) return;
        const std::vector<Plane> more = planes_across(mask, kind, request.planes);
        planes.insert(planes.end(), more.begin(), more.end());
    };
    add(request.axial, SliceKind::axial);
    add(request.sagittal, SliceKind::sagittal);
    add(request.coronal, SliceKind::coronal);
    return trace(mask, planes, kTraceOptions);
}

}  // namespace

Download Session::exported(const std::string& name, std::optional<Id> structure) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / name;
    Download download{name, "application/octet-stream", {}};
    if (name == "project.kontur") {
        const std::scoped_lock lock(mutex_);
        project_.copy_to(path);
        download.file_name = file_name(project_.path().stem().string(), name);
    } else {
        if (!structure) throw Error(ErrorKind::invalid_input, fmt::format("{} needs a structure", name));
        const State now = state();
        const Structure& chosen = structure_of(now, *structure);
        const ContourSet set = contour_set(now, *structure);
        if (is_one_of(name, kMasks)) write_mask_file(path, set, chosen, image_->grid);
        else if (is_one_of(name, kMeshes)) write_mesh_file(path, set, image_->grid);
        else if (is_one_of(name, kContours)) write_contours(path, set);
        else if (name == "picture.png") write_picture(path, set, *image_);
        else throw Error(ErrorKind::unsupported, "there is no export of this name");
        download.file_name = file_name(chosen.name, name);
    }
    download.bytes = read_bytes(path);
    return download;
}

std::vector<Id> Session::import_contours(const std::string& bytes, const std::string& extension) {
    const TemporaryFolder folder;
    const fs::path path = stored(folder, bytes, extension);
    const ReadContours read = reading(path, [&] { return read_contours(path); });
    check_contours(read.contours);
    for (const std::string& note : read.notes) notice("info", note);
    return add_structures("Import contours", {read.contours});
}

std::vector<Id> Session::import_mask(const std::string& bytes, const std::string& extension, const TraceRequest& request) {
    const TemporaryFolder folder;
    const fs::path path = stored(folder, bytes, extension);
    const Image labels = reading(path, [&] { return read_image(path); });
    std::vector<ContourSet> sets;
    const auto counts = count_labels(labels, kMostImportedLabels);
    for (const auto& [label, voxels] : counts) {
        sets.push_back(traced(select_label(labels, static_cast<double>(label)), request));
        sets.back().name = counts.size() == 1 ? "Imported mask" : fmt::format("Label {}", label);
    }
    if (sets.empty()) throw Error(ErrorKind::invalid_input, "the mask is empty");
    return add_structures("Import a mask", sets);
}

}  // namespace kontur::viewer
