// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/extract/rasterize.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/png.h"
#include "kontur/io/contours.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/image.h"
#include "kontur/io/images/segment_tags.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/segment.h"
#include "kontur/view/picture.h"
#include "viewer/files/import_doubts.h"
#include "viewer/files/structure_exports.h"
#include "viewer/model/file_names.h"
#include "viewer/model/label_values.h"
#include "viewer/model/model_json.h"
#include "viewer/model/status_line.h"
#include "viewer/model/temporary_files.h"
#include "viewer/session/replies.h"

// What leaves the session as files and comes in as files.

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::array kMasks{"mask.nii.gz", "mask.nii", "mask.nrrd", "mask.seg.nrrd", "mask.mha"};
constexpr std::array kMeshes{"mesh.stl", "mesh.ply", "mesh.obj"};
constexpr std::array kContours{"contours.json", "contours.mrk.json"};

template <class Names>
bool is_one_of(const std::string& name, const Names& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Of an image's file.
std::string without_image_ending(const std::string& file) {
    for (const char* ending : kMaskEndings)
        if (lower_case(file).ends_with(ending)) return file.substr(0, file.size() - std::string_view(ending).size());
    return file;
}

/// Whose image it is, and which: "Doe_Jane_Thorax_2mm" of DICOM, "scan17" of scan17.nii.gz.
std::string name_of_image(const SessionState& s) {
    const DicomIdentity& of = s.image.identity;
    const std::string patient = of.patient_name.empty() ? of.patient_id : of.patient_name;
    const std::string series = of.series_description.empty() ? of.series_number : of.series_description;
    if (patient.empty() && series.empty()) return plain_name(without_image_ending(s.image.title));
    if (patient.empty() || series.empty()) return plain_name(patient.empty() ? series : patient);
    return plain_name(fmt::format("{} {}", patient, series));
}

/// "scan17_Liver.nii.gz" for a mask of the liver.
std::string file_name(const SessionState& s, const std::string& of, const std::string& kind) {
    const std::string ending = kind.substr(kind.find('.'));
    if (of.empty()) return fmt::format("{}{}", name_of_image(s), ending);
    return fmt::format("{}_{}{}", name_of_image(s), plain_name(of), ending);
}

/// Of a mask to be corrected its own voxels, as `kontur correct` writes them.
void write_mask_file(const fs::path& path, const FittedStructure& one) {
    WriteMaskOptions options;
    options.segment_name = one.structure.name;
    options.segment_color = rgb(one.structure.color);
    options.segment_tags = tags_of_terms(one.set.attributes);
    options.provenance = provenance_of(one);
    write_mask(path, one.corrected ? one.corrected->mask : one.made.mask, options);
}

void write_mesh_file(const fs::path& path, const FittedStructure& one) {
    write_mesh(path, *one.made.mesh, provenance_of(one));
}

void write_picture(const fs::path& path, const FittedStructure& one, const Image& image) {
    const Segmentation& made = one.made;
    PictureOptions options;
    if (one.corrected)
        options.facts = {{"Volume (mask)", in_ml(one.corrected->report.volume_ml)},
                         {"Volume before", in_ml(one.corrected->report.volume_before_ml)},
                         {"Planes corrected", fmt::format("{}", one.corrected->report.planes.size())}};
    else
        options.facts = {{"Volume (mask)", in_ml(made.report.mask_volume_ml)},
                         {"Residual (max)", fmt::format("{:.2g} mm", made.report.residual.max_mm)},
                         {"Residual (rms)", fmt::format("{:.2g} mm", made.report.residual.rms_mm)}};
    write_png(path, make_picture(*made.mesh, one.set, &image, options), provenance_of(one));
}

/// Drawn by hand: what they were made of is the image alone.
Provenance provenance_of_drawing(const ContourSet& set, const ImageReference& image) {
    return {{"made_by", "kontur open"},
            {"image_fingerprint", image.fingerprint},
            {"contours_sha256", contours_sha256(set)},
            {"version", KONTUR_VERSION}};
}

/// Endings are known in small letters, and a DICOM file may have none.
std::string without_ending(const std::string& file, const std::string& ending) {
    return lower_case(file).ends_with(ending) ? file.substr(0, file.size() - ending.size()) : file;
}

/// Contours that fill each of their slices are a mask; others stay contours, with a note.
void make_masks(ImportContent& imported, const Grid& grid) {
    for (std::size_t n = 0; n < imported.sets.size(); ++n) {
        ContourSet& set = imported.sets[n];
        if (imported.masks.contains(n) || set.contours.empty()) continue;
        std::string why;
        try {
            const Mask mask = rasterize(set, grid);
            const FilledSlices slices = filled_slices(mask);
            if (slices.filled == 0) why = "no voxel of the image lies within its contours";
            else if (slices.filled < slices.extent)
                why = fmt::format("they fill {} of the {} slices from the first to the last", slices.filled, slices.extent);
            else {
                imported.masks[n] = {std::make_shared<const StoredMask>(mask)};
                ContourSet bare;
                bare.name = set.name;
                bare.attributes = set.attributes;
                set = std::move(bare);
            }
        } catch (const Error& error) {
            why = error.what();
        }
        if (!why.empty()) imported.notes.push_back(fmt::format("{} stays contours: {}", set.name, why));
    }
}

/// As contours that can be compared with the image: of a mask the corners of its box.
std::vector<ContourSet> extents_of(const ImportContent& imported) {
    std::vector<ContourSet> sets = imported.sets;
    for (const auto& [place, one] : imported.masks) {
        const IndexBox& box = one.mask->box();
        Contour corners;
        for (int corner = 0; corner < 8; ++corner)
            corners.points.push_back(one.mask->grid().center_mm(corner & 1 ? box.high.i : box.low.i,
                                                                corner & 2 ? box.high.j : box.low.j,
                                                                corner & 4 ? box.high.k : box.low.k));
        sets[place].contours = {corners};
    }
    return sets;
}

/// With a note for each.
void leave_out_taken_labels(ImportContent& imported, const State& state) {
    std::erase_if(imported.label_values, [&](const auto& item) {
        const Structure* const owner = owner_of_label(state, item.second, 0);
        if (owner)
            imported.notes.push_back(fmt::format("the label value {} of {} is that of {} here; another one is chosen",
                                                 item.second, imported.sets[item.first].name, owner->name));
        return owner != nullptr;
    });
}

}  // namespace

Download exported(SessionState& s, const std::string& name, std::optional<Id> structure, const StopToken& stop) {
    const StatusLine line(s.pages.status_teller(), "Exporting " + name);
    const TemporaryFolder folder;
    const fs::path path = folder.path() / name;
    Download download{name, "application/octet-stream", {}};
    if (name == "project.kontur") {
        const std::scoped_lock lock(s.mutex);
        s.project.copy_to(path);
        download.file_name = file_name(s, "", name);
    } else if (is_export_of_all(name)) {
        const ExportFits::Fits all = s.fits.all(s.state(), line.work(stop));
        for (const std::string& note : write_structures(path, name, *all, s.image.series, line.work(stop)))
            s.pages.notice("info", note);
        download.file_name = fmt::format("{}_{}", name_of_image(s), name);
    } else {
        if (!structure) throw Error(ErrorKind::invalid_input, fmt::format("{} needs a structure", name));
        const auto [now, image] = [&] {
            const std::scoped_lock lock(s.mutex);
            return std::pair(s.project.state(), s.project.image());
        }();
        const Structure& chosen = s.present_structure(now, *structure);
        const ContourSet set = contour_set(now, *structure);
        const auto made = [&, &now = now] { return s.fits.one(now, *structure, line.work(stop)); };
        if (is_one_of(name, kMasks)) write_mask_file(path, *made());
        else if (is_one_of(name, kMeshes)) write_mesh_file(path, *made());
        else if (chosen.mask && name == "contours.json")
            write_corrections_json(path, set, chosen.mask->confirmed_planes, provenance_of_drawing(set, image));
        else if (is_one_of(name, kContours)) write_contours(path, set, provenance_of_drawing(set, image));
        else if (name == "picture.png") write_picture(path, *made(), *s.image.voxels);
        else throw Error(ErrorKind::unsupported, "there is no export of this name");
        download.file_name = file_name(s, chosen.name, name);
    }
    download.bytes = read_bytes(path);
    return download;
}

ImportReply import(SessionState& s, const std::string& bytes, const Upload& upload, const StopToken& stop) {
    const StatusLine line(s.pages.status_teller(), "Importing");
    const Work work{.stop = stop};
    ImportContent imported = import_apart(bytes, upload, work);
    work.check();
    const std::string unnamed = without_ending(upload.file, upload.extension);
    for (ContourSet& set : imported.sets)
        if (set.name.empty()) set.name = unnamed;
    for (TracedMask& one : imported.traced)
        if (one.name.empty()) one.name = unnamed;
    if (upload.trace.preview) return {{}, {}, imported.notes, imported.traced};
    if (!upload.anyway) {
        auto doubts = import_doubts(extents_of(imported), {imported.frame_of_reference_uid, imported.patient},
                                    s.image.voxels->grid, {s.image.frame_of_reference_uid, patient_words(s.image.identity)});
        if (!doubts.empty()) return {{}, std::move(doubts), {}};
    }
    if (upload.purpose == Upload::Purpose::correct) make_masks(imported, s.image.voxels->grid);
    leave_out_taken_labels(imported, s.state());
    const bool is_mask = upload.content == Upload::Content::mask || !imported.masks.empty();
    return {add_structures(s, is_mask ? "Import a mask" : "Import contours", imported.sets, imported.label_values,
                           imported.masks),
            {},
            imported.notes};
}

}  // namespace kontur::viewer
