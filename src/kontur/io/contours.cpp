// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/json_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/contours/markups.h"
#include "kontur/io/contours/vtk_contours.h"
#include "kontur/io/contours_in_time.h"
#include "kontur/io/dicom/rtstruct_in_time.h"
#include "kontur/io/meshes/polydata.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

/// The first bytes, up to DICOM's mark and including it.
std::string head_of(const fs::path& path) {
    std::array<char, 132> head{};
    InputFile file(path);
    return {head.data(), file.read_some(head.data(), head.size())};
}

bool has_extension(const fs::path& path, std::string_view extension) {
    return lower_case(path.filename().string()).ends_with(extension);
}

bool is_dicom(const fs::path& path, std::string_view head) {
    return (head.size() == 132 && head.ends_with("DICM")) || has_extension(path, ".dcm");
}

bool is_json(std::string_view head) {
    const std::size_t start = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    return start != std::string_view::npos && (head[start] == '{' || head[start] == '[');
}

ReadContours read_roi(const fs::path& path, const ReadContoursOptions& options, const std::vector<DicomSeries>& frames) {
    const StructureSet set = read_rtstruct_in_time(path, frames);
    return in_context(path.string(), [&] {
        Roi roi = select_roi(set, options.roi);
        ReadContours found{std::move(roi.contours), std::move(roi.frame_of_reference_uid), set.notes};
        found.notes.insert(found.notes.end(), roi.notes.begin(), roi.notes.end());
        return found;
    });
}

bool is_structure_set(const fs::path& path) { return is_dicom(path, head_of(path)); }

/// What a file that is no structure set holds can be chosen by its name alone.
void check_name(const fs::path& path, const ContourSet& contours, const std::string& roi) {
    if (without_case(roi) == without_case(contours.name)) return;
    const std::string own = contours.name.empty() ? "one without a name" : "'" + contours.name + "'";
    throw Error(ErrorKind::invalid_input, path.string() + ": there is no structure '" + roi + "'; the file holds " + own);
}

ReadContours read_polylines(const fs::path& path, const ReadContoursOptions& options) {
    VtkContours found = read_vtk_contours(path, options.plane_tolerance_mm);
    if (options.roi) check_name(path, found.contours, *options.roi);
    return {std::move(found.contours), "", std::move(found.notes)};
}

void check_tolerance(const ReadContoursOptions& options) {
    check_tolerances({.plane_tolerance_mm = options.plane_tolerance_mm});
}

bool is_markups_name(const fs::path& path) { return has_extension(path, ".mrk.json"); }

bool is_markups(const fs::path& path, std::string_view head) {
    return !is_dicom(path, head) && !is_polydata(path, head) && is_json(head) &&
           (is_markups_name(path) || read_json_file(path).contains("markups"));
}

/// Of all files that are read together.
struct Splines {
    std::size_t count = 0;
    double off_mm = 0;  ///< at most

    void add(double curve_off_mm) {
        ++count;
        off_mm = std::max(off_mm, curve_off_mm);
    }
    std::string note() const {
        return fmt::format(
            "took {} as the spline that 3D Slicer draws, up to {:.2g} mm off straight lines; --curves polygon takes those",
            counted(count, "curve"), off_mm);
    }
};

void check_curves(const ReadContoursOptions& options, const std::vector<fs::path>& paths) {
    if (!options.curves) return;
    for (const fs::path& path : paths)
        if (is_markups(path, head_of(path))) return;
    throw Error(ErrorKind::invalid_input, "--curves is for 3D Slicer's markups (.mrk.json), and there are none");
}

ReadContours read_one(const fs::path& path, const ReadContoursOptions& options, Splines& splines,
                      const std::vector<DicomSeries>& frames = {}) {
    const std::string head = head_of(path);
    if (is_dicom(path, head)) return read_roi(path, options, frames);
    if (is_polydata(path, head)) return read_polylines(path, options);
    if (!is_json(head))
        throw Error(ErrorKind::unsupported,
                    path.string() +
                        " holds no contours: kontur's .json, 3D Slicer's .mrk.json, VTK's lines (.vtk, "
                        ".vtp) and DICOM RT structure sets are read");
    ReadContours found;
    if (is_markups(path, head))
        found.contours = read_markups(path, {options.plane_tolerance_mm, options.curves.value_or(Curves::spline),
                                             [&](std::string_view note) { found.notes.emplace_back(note); },
                                             [&](double off_mm) { splines.add(off_mm); }});
    else found.contours = read_contour_json(path);
    if (options.roi) check_name(path, found.contours, *options.roi);
    return found;
}

}  // namespace

ReadContours read_contours(const fs::path& path, const ReadContoursOptions& options) {
    check_tolerance(options);
    check_curves(options, {path});
    Splines splines;
    ReadContours found = read_one(path, options, splines);
    if (splines.count > 0) found.notes.push_back(splines.note());
    return found;
}

ReadContours read_contours(const std::vector<fs::path>& paths, const ReadContoursOptions& options) {
    return read_contours_in_time(paths, options, {});
}

ReadContours read_contours_in_time(const std::vector<fs::path>& paths, const ReadContoursOptions& options,
                                   const std::vector<DicomSeries>& frames) {
    check_tolerance(options);
    check_curves(options, paths);
    ReadContours all;
    Splines splines;
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    ReadContoursOptions of_others = options;
    if (options.roi && std::any_of(paths.begin(), paths.end(), is_structure_set)) of_others.roi.reset();
    for (const fs::path& path : paths) {
        const ReadContours one = read_one(path, is_structure_set(path) ? options : of_others, splines, frames);
        if (all.contours.name.empty()) all.contours.name = one.contours.name;
        if (all.contours.attributes == StructureAttributes{}) all.contours.attributes = one.contours.attributes;
        if (all.frame_of_reference_uid.empty()) all.frame_of_reference_uid = one.frame_of_reference_uid;
        if (!one.frame_of_reference_uid.empty() && one.frame_of_reference_uid != all.frame_of_reference_uid)
            throw Error(ErrorKind::invalid_input,
                        path.string() + ": its contours lie in the frame of reference " + one.frame_of_reference_uid +
                            ", those before in " + all.frame_of_reference_uid +
                            "; contours of one object have to share one, so register the images first");
        if (!all.contours.cycle_frames) all.contours.cycle_frames = one.contours.cycle_frames;
        if (!all.contours.cycle_s) all.contours.cycle_s = one.contours.cycle_s;
        append(all.contours.contours, one.contours.contours);
        append(all.contours.interior, one.contours.interior);
        append(all.contours.exterior, one.contours.exterior);
        append(all.contours.surface, one.contours.surface);
        append(all.contours.empty_planes, one.contours.empty_planes);
        for (const std::string& note : one.notes) all.notes.push_back(path.string() + ": " + note);
    }
    if (splines.count > 0) all.notes.push_back(splines.note());
    return all;
}

void write_contours(const fs::path& path, const ContourSet& set, const Provenance& provenance) {
    if (is_markups_name(path)) write_markups(path, set, provenance);
    else if (has_extension(path, ".json")) write_contour_json(path, set, provenance);
    else
        throw Error(ErrorKind::unsupported,
                    "contours are written to names that end in .json or .mrk.json, not to " + path.filename().string());
}

}  // namespace kontur
