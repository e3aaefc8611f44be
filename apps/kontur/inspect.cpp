// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "commands.h"
#include "describe.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom_seg.h"
#include "kontur/io/mesh.h"
#include "kontur/io/rtstruct.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

Facts inspect_segmentation(const InspectCommand& command, const fs::path& path) {
    const DicomSegmentation found = read_dicom_segmentation(path, command.read.max_voxels);
    Facts segments = Facts::array();
    for (const DicomSegment& s : found.segments)
        segments.push_back({{"number", s.number},
                            {"name", s.label},
                            {"algorithm_type", s.algorithm_type},
                            {"algorithm", s.algorithm_name},
                            {"voxels", s.voxels},
                            {"volume_ml", number(static_cast<double>(s.voxels) * found.grid.voxel_volume_mm3() / 1000)}});
    Facts facts = {{"kind", "segmentation"}};
    facts.update(describe(found.grid));
    facts["segments"] = segments;
    facts["notes"] = found.notes;
    return facts;
}

Facts inspect_image(const InspectCommand& command, const fs::path& path, Console& console) {
    std::vector<std::string> notes;
    ReadImageOptions options = command.read;
    options.on_note = [&](std::string_view note) { notes.emplace_back(note); };
    Facts facts = {{"kind", "image"}};
    facts.update(describe(read_image(path, options, console.progress())));
    facts["notes"] = notes;
    return facts;
}

Facts inspect_structure_set(const fs::path& path) {
    const StructureSet set = read_rtstruct(path);
    Facts rois = Facts::array();
    for (const Roi& roi : set.rois) {
        Facts facts = {{"number", roi.number}, {"name", roi.contours.name}, {"type", roi.interpreted_type}};
        facts.update(describe(roi.contours));
        facts.erase("interior_points");  // which RTSTRUCT does not know
        facts.erase("exterior_points");
        facts["notes"] = roi.notes;
        rois.push_back(std::move(facts));
    }
    return {{"kind", "structure set"}, {"label", set.label}, {"rois", rois}};
}

Facts inspect_contours(const fs::path& path) {
    if (looks_like_dicom(path)) return inspect_structure_set(path);
    Facts facts = {{"kind", "contours"}};
    facts.update(describe(read_contours(path).contours));
    return facts;
}

Facts inspect_mesh(const fs::path& path) {
    Facts facts = {{"kind", "mesh"}};
    facts.update(describe(read_mesh(path)));
    return facts;
}

Facts inspect(const InspectCommand& command, const fs::path& path, Console& console) {
    switch (input_kind(path)) {
        case FileKind::image:
            if (is_dicom_seg(path)) return inspect_segmentation(command, path);
            return inspect_image(command, path, console);
        case FileKind::contours:
            return inspect_contours(path);
        case FileKind::mesh:
            break;
    }
    return inspect_mesh(path);
}

}  // namespace

void run(const InspectCommand& command, Console& console) {
    Facts all = Facts::array();
    std::optional<Error> first_error;
    for (const fs::path& path : command.files) {
        Facts facts;
        try {
            facts = inspect(command, path, console);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            facts["error"] = error.what();
            if (!first_error) first_error = error;
        }
        if (!command.json) console.print(path.string() + "\n" + to_text(facts));
        all.push_back({{"file", path.string()}});
        all.back().update(facts);
    }
    if (command.json) console.print(all.dump(2) + "\n");
    if (first_error) throw *first_error;
}

}  // namespace kontur::app
