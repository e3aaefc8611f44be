// SPDX-License-Identifier: Apache-2.0
#include "roi_outputs.h"

#include <fmt/format.h>

#include <algorithm>

#include "contour_files.h"
#include "kontur/base/machine_memory.h"
#include "kontur/io/meshes/region_mesh.h"
#include "kontur/segment_report.h"
#include "own_grid.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

Facts pairs_of(const std::vector<StructurePair>& pairs, const std::vector<FittedRoi>& all) {
    Facts facts = Facts::array();
    for (const StructurePair& pair : pairs)
        facts.push_back({{"first", all[pair.first].segment.label},
                         {"second", all[pair.second].segment.label},
                         {"relation", name(pair.relation)},
                         {"given", pair.is_given},
                         {"shared_voxels", pair.shared_voxels}});
    return facts;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<FittedRoi>& all) {
    std::vector<std::string> names;
    for (const FittedRoi& one : all) names.push_back(one.segment.label);
    return names;
}

FittedRoi fitted_roi(const RoiDrawings& drawings, std::size_t n, SegmentReport report) {
    const Roi& roi = drawings.rois[n];
    StructureAttributes attributes = fitted_attributes(roi.contours.attributes);
    if (!attributes.color) attributes.color = structure_color(n);
    FittedRoi fitted;
    fitted.segment = fitted_segment(attributes);
    fitted.segment.label = roi.name;
    fitted.provenance = provenance(roi.contours, drawings.grid, report);
    fitted.report = std::move(report);
    put_notes_first(roi.notes, fitted.report.warnings);
    fitted.roi.name = roi.name;
    fitted.roi.number = roi.number;
    fitted.roi.contours.attributes = std::move(attributes);
    return fitted;
}

Provenance common_provenance(const std::vector<FittedRoi>& all) {
    Provenance provenance = all.front().provenance;
    Provenance others;
    for (auto& [name, value] : provenance) {
        const auto same = [&, &name = name, &value = value](const FittedRoi& one) {
            return std::find(one.provenance.begin(), one.provenance.end(), std::pair{name, value}) != one.provenance.end();
        };
        if (std::all_of(all.begin(), all.end(), same)) continue;
        for (std::size_t n = 0; n < all.size(); ++n)
            for (const auto& [its_name, its_value] : all[n].provenance)
                if (its_name == name) others.emplace_back(fmt::format("{}_{}", name, n + 1), its_value);
        name.clear();
    }
    std::erase_if(provenance, [](const auto& entry) { return entry.first.empty(); });
    provenance.insert(provenance.end(), others.begin(), others.end());
    return provenance;
}

void RoiResults::add(const SegmentCommand& command, FittedRoi one, ContourSet outlines, Mask mask, const IndexBox& box) {
    name_margin(command, one.report.warnings);
    outlines.name = one.roi.name;
    outlines.attributes = std::move(one.roi.contours.attributes);
    one.roi.contours = std::move(outlines);
    all.push_back(std::move(one));
    DicomSegment& segment = all.back().segment;
    segment.number = static_cast<std::int64_t>(all.size());
    if (!has_room_for_overlap(command.output)) return labels.add(mask, box, static_cast<std::uint16_t>(all.size()));
    if (is_dicom_name(command.output) && std::find(mask.values.begin(), mask.values.end(), 1) == mask.values.end()) {
        segment.number = 0;
        notes.push_back(fmt::format("'{}' has no voxels of this grid and is no segment of the SEG", segment.label));
        return;
    }
    segment.number = static_cast<std::int64_t>(structures.segments.size() + 1);
    structures.segments.push_back(segment);
    structures.masks.push_back(std::move(mask));
}

void put_left_out(const std::vector<LeftOutRoi>& left_out, Facts& report) {
    for (const LeftOutRoi& one : left_out)
        report["left_out"].push_back({{"name", one.roi.name}, {"number", one.roi.number}, {"reason", one.reason}});
}

Facts roi_report(const RoiResults& result, const Provenance& provenance) {
    Facts structures = Facts::array(), derived = Facts::array();
    for (const FittedRoi& one : result.all) {
        if (!one.rule.empty()) {
            derived.push_back({{"label", one.segment.number},
                               {"name", one.segment.label},
                               {"rule", one.rule},
                               {"voxels", one.report.mask_voxels},
                               {"volume_ml", one.report.mask_volume_ml}});
            continue;
        }
        Facts facts{{"label", one.segment.number}, {"name", one.segment.label}};
        facts.update(Facts::parse(kontur::to_json(one.report, one.provenance)));
        structures.push_back(std::move(facts));
    }
    Facts report{{"version", KONTUR_VERSION},
                 {"provenance", provenance_facts(provenance)},
                 {"structures", structures},
                 {"warnings", result.notes}};
    if (!derived.empty()) report["derived"] = derived;
    put_left_out(result.left_out, report);
    if (result.together)
        report["together"] = {{"pairs", pairs_of(result.together->pairs, result.all)},
                              {"contested_voxels", result.together->contested_voxels},
                              {"closed_voxels", result.together->closed_voxels},
                              {"borrowed_points", result.together->borrowed_points},
                              {"peak_memory_mb", peak_memory_mb()}};
    return report;
}

std::vector<LabelName> label_names(const std::vector<FittedRoi>& all) {
    std::vector<LabelName> names;
    for (const FittedRoi& one : all)
        names.push_back({one.segment.number, one.segment.label, to_levels(one.segment.color.value_or(kStructureColor))});
    return names;
}

std::vector<std::string> write_label_map(const fs::path& path, const RoiResults& result, const Provenance& provenance) {
    kontur::write_image(path, result.labels.image(), label_names(result.all), provenance);
    return result.labels.notes(names_of(result.all));
}

std::vector<std::string> write_roi_contours(const fs::path& path, const SegmentCommand& command,
                                            const std::vector<FittedRoi>& all, const Provenance& provenance) {
    StructureSet set{"kontur", {}};
    for (const FittedRoi& one : all) set.rois.push_back(one.roi);
    const DicomSeries series = read_dicom_grid(command.image.path, command.image.options.dicom).series;
    return write_rtstruct(path, set, series, rtstruct_options(command.holes, command.series, provenance));
}

void write_roi_surfaces(const fs::path& path, const RoiResults& result, const Provenance& provenance) {
    MeshRegions regions{{}, result.surface->sides};
    for (const std::vector<std::size_t>& members : result.surface->regions) {
        std::string& name = regions.names.emplace_back();
        for (const std::size_t n : members) name += (name.empty() ? "" : " and ") + result.all[n].segment.label;
        if (members.empty()) name = "outside";
    }
    write_region_mesh(path, result.surface->mesh, regions, provenance);
}

}  // namespace kontur::app
