// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "commands.h"
#include "describe.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/images/frame_choice_error.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/io/read_provenance.h"
#include "kontur/measure/contour_check.h"
#include "structures.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

Facts inspect_segmentation(const InspectCommand& command, const fs::path& path) {
    const DicomSegmentation found = read_dicom_segmentation(path, command.read.max_voxels);
    Facts segments = Facts::array();
    for (const DicomSegment& s : found.segments) {
        segments.push_back({{"number", s.number},
                            {"name", s.label},
                            {"algorithm_type", s.algorithm_type},
                            {"algorithm", s.algorithm_name},
                            {"voxels", s.voxels},
                            {"shared_voxels", s.shared_voxels},
                            {"volume_ml", number(static_cast<double>(s.voxels) * found.grid.voxel_volume_mm3() / 1000)}});
        StructureAttributes said = attributes_of(s);
        said.generation_algorithm.clear();  // told above
        segments.back().update(describe(said));
    }
    Facts facts = {{"kind", "segmentation"}};
    facts.update(describe(found.grid));
    facts["segments"] = segments;
    facts["notes"] = found.notes;
    return facts;
}

/// Of several frames, where none was chosen, the first stands for all: a file is to be looked at before that is known.
Facts describe_frame(const fs::path& path, ReadImageOptions options, const Work& work) {
    try {
        return describe(read_label_image(path, options, work));
    } catch (const FrameChoiceError& needed) {
        options.frame = 1;
        Facts facts = describe(read_label_image(path, options, work));
        facts["frames"] = needed.frames();
        if (options.on_note) options.on_note("the values are those of frame 1; --frame takes another");
        return facts;
    }
}

/// Labels get the names that a .seg.nrrd has for them.
void name_labels(const ImageInput& input, Facts& facts) {
    if (!facts.contains("labels")) return;
    for (const DicomSegment& segment : named_segments(input))
        for (Facts& label : facts["labels"])
            if (label["label"] == segment.number) label["name"] = segment.label;
}

Facts inspect_image(const InspectCommand& command, const fs::path& path, Console& console) {
    std::vector<std::string> notes;
    ReadImageOptions options = command.read;
    std::vector<std::string> warnings;
    options.on_note = [&](std::string_view note) { notes.emplace_back(note); };
    options.on_warning = [&](std::string_view warning) { warnings.emplace_back(warning); };
    Facts facts = {{"kind", "image"}};
    facts.update(describe_frame(path, options, console.work()));
    name_labels({path, options}, facts);
    facts["notes"] = notes;
    if (!warnings.empty()) facts["warnings"] = warnings;
    for (const std::string& warning : warnings) console.warn_once(warning);
    return facts;
}

/// The segments of a .seg.nrrd that overlap, on layers, as those of a DICOM SEG are shown.
Facts inspect_layers(const InspectCommand& command, const fs::path& path, Console& console) {
    std::vector<std::string> notes;
    ImageInput input{path, command.read};
    input.options.on_note = [&](std::string_view note) { notes.emplace_back(note); };
    const Structures found = read_structures(input, console.work());
    const Grid grid = read_grid(path, command.read);
    std::vector<std::uint16_t> structures_at(static_cast<std::size_t>(grid.voxel_count()));
    for (const Mask& mask : found.masks)
        for (std::size_t v = 0; v < structures_at.size(); ++v) structures_at[v] += mask.values[v];
    Facts segments = Facts::array();
    for (std::size_t n = 0; n < found.masks.size(); ++n) {
        std::int64_t voxels = 0, shared = 0;
        for (std::size_t v = 0; v < structures_at.size(); ++v)
            if (found.masks[n].values[v] != 0) ++voxels, shared += structures_at[v] > 1;
        segments.push_back({{"number", found.segments[n].number},
                            {"name", found.segments[n].label},
                            {"voxels", voxels},
                            {"shared_voxels", shared},
                            {"volume_ml", number(static_cast<double>(voxels) * grid.voxel_volume_mm3() / 1000)}});
        segments.back().update(describe(attributes_of(found.segments[n])));
    }
    Facts facts = {{"kind", "segmentation"}};
    facts.update(describe(grid));
    facts["segments"] = segments;
    facts["notes"] = notes;
    return facts;
}

Facts finding_json(const Finding& finding, const std::string& roi) {
    Facts facts = {{"severity", name(finding.severity)}, {"kind", name(finding.kind)}};
    if (!roi.empty()) facts["roi"] = roi;
    if (finding.contour) facts["contour"] = *finding.contour + 1;
    if (finding.other) facts["other"] = *finding.other + 1;
    if (const auto& p = finding.position) facts["position_mm"] = {number(p->x), number(p->y), number(p->z)};
    if (finding.value_mm) facts["value_mm"] = number(*finding.value_mm);
    facts["text"] = finding.text;
    return facts;
}

/// The same for people, one line.
std::string finding_line(const Facts& finding) {
    const std::string roi = finding.contains("roi") ? finding["roi"].get<std::string>() + ": " : "";
    std::string line =
        fmt::format("{}: {}{}", finding["severity"].get<std::string>(), roi, finding["text"].get<std::string>());
    if (finding.contains("position_mm") && finding["kind"] != name(FindingKind::contradiction)) {  // which names it itself
        const Facts& p = finding["position_mm"];
        line += fmt::format(" at ({:.1f}, {:.1f}, {:.1f}) mm", p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
    }
    return line;
}

void append_findings(const ContourSet& contours, const std::string& roi, Facts& facts) {
    Facts& list = facts.emplace("findings", Facts::array()).first.value();
    for (const Finding& finding : check_contour_set(contours)) list.push_back(finding_json(finding, roi));
}

/// Findings and provenance become lines; everything else stays.
Facts for_people(Facts facts) {
    if (facts.contains("findings"))
        for (Facts& finding : facts["findings"]) finding = finding_line(finding);
    if (facts.contains("provenance")) {
        Facts lines = Facts::array();
        for (const auto& [name, value] : facts["provenance"].items())
            lines.push_back(fmt::format("{}: {}", name, value.get<std::string>()));
        facts["provenance"] = lines;
    }
    return facts;
}

std::size_t error_count(const Facts& facts) {
    std::size_t count = 0;
    if (facts.contains("findings"))
        for (const Facts& finding : facts["findings"]) count += finding["severity"] == name(Severity::error);
    return count;
}

/// Of the first damaged ROI; else "".
std::string first_damage(const Facts& facts) {
    if (facts.contains("rois"))
        for (const Facts& roi : facts["rois"])
            if (roi.contains("damage")) return roi["damage"].get<std::string>();
    return "";
}

Facts inspect_structure_set(const InspectCommand& command, const fs::path& path) {
    const StructureSet set = read_rtstruct(path);
    Facts rois = Facts::array();
    for (const Roi& roi : set.rois) {
        Facts facts = {
            {"number", roi.number}, {"name", roi.contours.name}, {"type", roi.contours.attributes.interpreted_type}};
        facts.update(describe(roi.contours));
        facts.update(describe(roi.contours.attributes));
        facts.erase("interior_points");  // which RTSTRUCT does not know
        facts.erase("exterior_points");
        facts.erase("empty_planes");
        facts["notes"] = roi.notes;
        if (!roi.damage.empty()) {
            facts["damage"] = roi.damage;
            facts.erase("problems");  // of contours that were not read
        }
        rois.push_back(std::move(facts));
    }
    Facts facts = {{"kind", "structure set"}, {"label", set.label}, {"rois", rois}, {"notes", set.notes}};
    if (command.check)
        for (const Roi& roi : set.rois)
            if (!roi.contours.contours.empty()) append_findings(roi.contours, roi.contours.name, facts);
    return facts;
}

Facts inspect_contours(const InspectCommand& command, const fs::path& path) {
    if (looks_like_dicom(path)) return inspect_structure_set(command, path);
    Facts facts = {{"kind", "contours"}};
    const ContourSet contours = read_contours(path).contours;
    facts.update(describe(contours));
    facts.update(describe(contours.attributes));
    if (command.check) append_findings(contours, "", facts);
    return facts;
}

Facts inspect_mesh(const fs::path& path) {
    Facts facts = {{"kind", "mesh"}};
    facts.update(describe(read_mesh(path)));
    return facts;
}

Facts inspect_by_kind(const InspectCommand& command, const fs::path& path, Console& console) {
    switch (input_kind(path)) {
        case FileKind::image:
            if (is_dicom_seg(path)) return inspect_segmentation(command, path);
            if (may_overlap({path, command.read})) return inspect_layers(command, path, console);
            return inspect_image(command, path, console);
        case FileKind::contours:
            return inspect_contours(command, path);
        case FileKind::mesh:
            break;
    }
    return inspect_mesh(path);
}

Facts inspect(const InspectCommand& command, const fs::path& path, Console& console) {
    Facts facts = inspect_by_kind(command, path, console);
    for (const auto& [name, value] : read_provenance(path)) facts["provenance"][name] = value;
    return facts;
}

bool holds_contours(const fs::path& path) { return input_kind(path) == FileKind::contours; }

}  // namespace

void run(const InspectCommand& command, Console& console) {
    Facts all = Facts::array();
    std::optional<Error> first_error;
    for (const fs::path& path : command.files) {
        Facts facts;
        try {
            facts = inspect(command, path, console);
            if (const std::string damage = first_damage(facts); !damage.empty() && !first_error)
                first_error = Error(ErrorKind::corrupt_file, path.string() + ": " + damage);
            if (const std::size_t errors = error_count(facts); errors > 0 && !first_error)
                first_error =
                    Error(ErrorKind::invalid_input, fmt::format("{} has {}", path.string(), counted(errors, "error")));
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            facts["error"] = error.what();
            if (!first_error) first_error = error;
        }
        if (!command.json) console.print(path.string() + "\n" + to_text(for_people(facts)));
        all.push_back({{"file", path.string()}});
        all.back().update(facts);
    }
    if (command.json) console.print(to_json_text(all));
    if (first_error) throw *first_error;
    if (command.check && std::none_of(command.files.begin(), command.files.end(), holds_contours))
        throw Error(ErrorKind::invalid_input, "--check is for contours, which none of the files holds");
}

}  // namespace kontur::app
