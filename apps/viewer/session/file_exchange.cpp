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
#include "kontur/io/image_frames.h"
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
#include "viewer/session/events.h"
#include "viewer/session/replies.h"

// What leaves the session as files and comes in as files.

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::array kMasks{"mask.nii.gz", "mask.nii", "mask.nrrd", "mask.seg.nrrd", "mask.mha"};
constexpr std::string_view kMasksOfAll = "masks.nii.gz";  ///< at all times
constexpr std::string_view kVolumes = "volumes.csv";
constexpr std::string_view kLabelsOfAll = "label_frames.nii.gz";  ///< of all structures at all times
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
    const LabelName label{
        .name = one.structure.name, .color = rgb(one.structure.color), .tags = tags_of_terms(one.set.attributes)};
    write_mask(path, one.corrected ? one.corrected->mask : one.segmentation.mask, label, provenance_of(one));
}

void write_mesh_file(const fs::path& path, const FittedStructure& one) {
    write_mesh(path, *one.segmentation.mesh, provenance_of(one));
}

/// With the contours of the time, where they are of several.
void write_picture(const fs::path& path, const FittedStructure& one, const Image& image, int time) {
    const Segmentation& segmentation = one.segmentation;
    PictureOptions options;
    if (one.corrected)
        options.facts = {{"Volume (mask)", in_ml(one.corrected->report.volume_ml)},
                         {"Volume before", in_ml(one.corrected->report.volume_before_ml)},
                         {"Planes corrected", fmt::format("{}", one.corrected->report.planes.size())}};
    else if (one.is_derived)
        options.facts = {{"Volume (mask)", in_ml(segmentation.report.mask_volume_ml)}, {"Rule", *one.structure.rule}};
    else
        options.facts = {{"Volume (mask)", in_ml(segmentation.report.mask_volume_ml)},
                         {"Residual (max)", fmt::format("{:.2g} mm", segmentation.report.residual.max_mm)},
                         {"Residual (rms)", fmt::format("{:.2g} mm", segmentation.report.residual.rms_mm)}};
    ContourSet drawn = one.set;
    std::erase_if(drawn.contours, [&](const Contour& contour) { return contour.frame && *contour.frame != time + 1; });
    write_png(path, make_picture(*segmentation.mesh, drawn, &image, options), provenance_of(one));
}

/// That a picture of the structure shows: of one that moves the one that is looked at.
int picture_time(const State& now, Id structure, std::optional<int> time) {
    const std::set<int> times = drawn_times(now, structure);
    if (times.size() > 1) return time.value_or(now.opened_time);
    return times.empty() || structure_of(now, structure).mask ? now.opened_time : *times.begin();
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
            if (is_moving(set)) throw Error(ErrorKind::unsupported, "they are of several frames");
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

/// DICOM objects refer to the images of one time.
void check_is_of_one_time(const SessionState& s, const State& now, const ExportChoice& choice) {
    if (!choice.name.ends_with(".dcm")) return;
    const int own = s.image.times.own();
    for (const auto& [id, structure] : now.structures) {
        const std::set<int> times = drawn_times(now, id);
        if (structure.mask || times.empty() || (times.contains(own) && choice.time.value_or(own) == own)) continue;
        throw Error(ErrorKind::unsupported,
                    times.size() > 1
                        ? fmt::format("{} refers to the images of frame {}, and {} moves; go to that frame to write what it "
                                      "is there, or write masks.nii.gz of all frames",
                                      choice.name, own + 1, structure.name)
                        : fmt::format("{} refers to the images of frame {}, and {} was drawn in frame {}; write its mask as "
                                      "NIfTI",
                                      choice.name, own + 1, structure.name, *times.begin() + 1));
    }
}

/// A file of a structure that moves.
void write_motion(SessionState& s, const State& now, const ExportChoice& choice, const fs::path& path, const Work& work) {
    const Structure& chosen = structure_of(now, *choice.structure);
    if (!is_moving(now, chosen.id))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} was drawn in one frame; {} is of a structure that was drawn in several", chosen.name,
                                choice.name));
    const auto motion = s.fits.motion(now, chosen.id, work);
    if (choice.name == kVolumes) return write_file_atomically(path, motion->volumes_csv(s.image.frame_step_s));
    write_masks(path, motion->masks(), s.image.frame_step_s, 1, motion->provenance());
}

void write_label_frames(SessionState& s, const State& now, const fs::path& path, const Work& work) {
    if (s.image.times.count() < 2)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the image has 1 frame; {} is of an image with several", kLabelsOfAll));
    LabelFrames labels;
    for (int time = 0; time < s.image.times.count(); ++time) labels.add(*s.fits.all(now, work, {time, false}));
    labels.write(path, s.image.frame_step_s);
    for (const std::string& note : labels.notes()) s.pages.notice("info", note);
}

/// With their frames where the image has several, and the cycle.
ContourSet contours_in_time(const State& now, Id structure) {
    ContourSet set = contour_set(now, structure);  // with frames, if it moves
    const std::set<int> times = drawn_times(now, structure);
    if (times.size() == 1 && *times.begin() != now.opened_time && !structure_of(now, structure).mask)
        set_frames(set, std::vector(set.contours.size(), *times.begin()), now);
    return set;
}

/// A file of one structure.
void write_one(SessionState& s, const State& now, const ExportChoice& choice, const fs::path& path, const Work& work) {
    const std::string& name = choice.name;
    const Structure& chosen = structure_of(now, *choice.structure);
    const bool mesh = is_one_of(name, kMeshes) || name == "picture.png";
    const auto fitted = [&] { return s.fits.one(now, chosen.id, work, {choice.time, mesh}); };
    const ContourSet set = chosen.rule ? fitted()->set : contours_in_time(now, chosen.id);
    const ImageReference image = [&] {
        const std::scoped_lock lock(s.mutex);
        return s.project.image();
    }();
    if (name == kMasksOfAll || name == kVolumes) return write_motion(s, now, choice, path, work);
    if (is_one_of(name, kMasks)) return write_mask_file(path, *fitted());
    if (is_one_of(name, kMeshes)) return write_mesh_file(path, *fitted());
    if (chosen.mask && name == "contours.json")
        return write_corrections_json(path, set, chosen.mask->confirmed_planes, provenance_of_drawing(set, image));
    if (name == "contours.mrk.json" && is_moving(now, chosen.id))
        throw Error(ErrorKind::unsupported, fmt::format("{} holds contours of one frame, and {} was drawn in several; write "
                                                        "contours.json",
                                                        name, chosen.name));
    if (is_one_of(name, kContours))
        return write_contours(path, set, chosen.rule ? provenance_of(*fitted()) : provenance_of_drawing(set, image));
    if (name != "picture.png") throw Error(ErrorKind::unsupported, "there is no export of this name");
    const int time = picture_time(now, chosen.id, choice.time);
    write_picture(path, *fitted(), *s.image.times.image(time), time);
}

}  // namespace

Download exported(SessionState& s, const ExportChoice& choice, const StopToken& stop) {
    const std::string& name = choice.name;
    const StatusLine line(s.pages.status_teller(), "Exporting " + name);
    const TemporaryFolder folder;
    const fs::path path = folder.path() / name;
    Download download{name, "application/octet-stream", {}};
    time_from(s, choice.time);
    if (name == "project.kontur") {
        const std::scoped_lock lock(s.mutex);
        s.project.copy_to(path);
        download.file_name = file_name(s, "", name);
    } else if (is_export_of_all(name)) {
        const State now = s.state();
        check_is_of_one_time(s, now, choice);
        const ExportFits::Fits all = s.fits.all(now, line.work(stop), {choice.time, name.ends_with(".zip")});
        for (const std::string& note : write_structures(path, name, *all, s.image.series, line.work(stop)))
            s.pages.notice("info", note);
        download.file_name = fmt::format("{}_{}", name_of_image(s), name);
    } else if (name == kLabelsOfAll) {
        write_label_frames(s, s.state(), path, line.work(stop));
        download.file_name = fmt::format("{}_{}", name_of_image(s), name);
    } else {
        if (!choice.structure) throw Error(ErrorKind::invalid_input, fmt::format("{} needs a structure", name));
        const State now = s.state();
        const Structure& chosen = s.present_structure(now, *choice.structure);
        write_one(s, now, choice, path, line.work(stop));
        const bool is_of_frame = is_moving(now, chosen.id) && (is_one_of(name, kMasks) || is_one_of(name, kMeshes));
        const std::string frame =
            is_of_frame ? fmt::format(" frame {}", choice.time.value_or(s.image.times.own()) + 1) : std::string();
        download.file_name = file_name(s, chosen.name + frame, name);
    }
    download.bytes = read_bytes(path);
    return download;
}

ImportReply import(SessionState& s, const std::string& bytes, const Upload& upload, const StopToken& stop) {
    const StatusLine line(s.pages.status_teller(), "Importing");
    const Work work{.stop = stop};
    Upload placed = upload;
    if (s.image.series && s.image.times.count() > 1) {
        placed.images = s.project.image().path;
        placed.series_uid = s.image.series->series_uid;
    }
    ImportContent imported = import_apart(bytes, placed, work);
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
