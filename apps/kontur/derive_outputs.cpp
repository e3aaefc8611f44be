// SPDX-License-Identifier: Apache-2.0
#include "derive_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "dicom_output.h"
#include "kontur/base/error.h"
#include "kontur/derive/derived_attributes.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/contours.h"
#include "kontur/io/dicom/derived_segment.h"
#include "kontur/labels/section_contours.h"
#include "roi_label_map.h"
#include "structures.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

constexpr std::array kTypes{"GTV", "CTV", "PTV", "ORGAN", "AVOIDANCE", "EXTERNAL"};

struct NamedType {
    std::string name, type;
};

/// Names may hold '=': the last one parts them.
NamedType named_type(const std::string& words) {
    const std::size_t at = words.rfind('=');
    const std::string type = at == std::string::npos ? "" : words.substr(at + 1);
    if (at == std::string::npos || at == 0 || std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end())
        refuse(fmt::format("--type is '{}'; it is NAME=TYPE with one of {}", words, fmt::join(kTypes, ", ")));
    return {words.substr(0, at), type};
}

bool is_empty(const Mask& mask) { return std::find(mask.values.begin(), mask.values.end(), 1) == mask.values.end(); }

DicomSegment segment_of(const DeriveOutput& one, std::size_t number) {
    DicomSegment segment = one.is_derived ? derived_segment(one.outlines.name, one.outlines.attributes)
                                          : fitted_segment(one.outlines.attributes);
    segment.label = one.outlines.name;
    segment.number = static_cast<std::int64_t>(number);
    return segment;
}

Structures structures_of(const std::vector<DeriveOutput>& all, std::vector<std::string>& notes) {
    Structures found;
    for (const DeriveOutput& one : all) {
        if (is_empty(one.mask)) {
            notes.push_back(fmt::format("'{}' has no voxels and is no segment", one.outlines.name));
            continue;
        }
        found.segments.push_back(segment_of(one, found.segments.size() + 1));
        found.masks.push_back(one.mask);
    }
    if (found.masks.empty()) refuse("no structure has a voxel, and a segmentation needs at least 1 that has");
    return found;
}

std::vector<std::string> write_map(const fs::path& path, const std::vector<DeriveOutput>& all,
                                   const Provenance& provenance) {
    const Grid& grid = all.front().mask.grid;
    const IndexBox whole{{0, 0, 0}, {grid.size.i - 1, grid.size.j - 1, grid.size.k - 1}};
    RoiLabelMap map(grid, false);
    std::vector<std::string> names;
    std::vector<LabelName> labels;
    for (const DeriveOutput& one : all) {
        const auto label = static_cast<std::uint16_t>(names.size() + 1);
        map.add(one.mask, whole, label);
        names.push_back(one.outlines.name);
        labels.push_back({label, one.outlines.name, to_levels(*one.outlines.attributes.color)});
    }
    kontur::write_image(path, map.image(), labels, provenance);
    return map.notes(names);
}

std::string cell(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

std::string farthest_cells(double mm, const Vec3& place) {
    return mm > 0 ? fmt::format("{:.4g},{:.2f},{:.2f},{:.2f}", mm, place.x, place.y, place.z) : "0,,,";
}

}  // namespace

DicomSegment derived_segment(const std::string& name, const StructureAttributes& attributes) {
    DicomSegment segment = kontur::derived_segment(attributes);
    segment.label = name;
    return segment;
}

void check_types(const std::vector<std::string>& types) {
    for (const std::string& words : types) named_type(words);
}

std::vector<DeriveOutput> derive_outputs(const DeriveCommand& command, const DeriveSources& sources,
                                         std::vector<DerivedStructure> derived, const Work& work) {
    std::vector<DeriveOutput> all;
    if (command.with_sources)
        for (std::size_t n = 0; n < sources.structures.size(); ++n) {
            const NamedStructure& one = sources.structures[n];
            ContourSet outlines =
                one.function ? slice_contours(one.mask, *one.function, work.untold()) : slice_outlines(one.mask);
            outlines.name = one.name;
            outlines.attributes = sources.attributes[n];
            outlines.attributes.number.reset();
            outlines.attributes.review = {.comment = outlines.attributes.review.comment};  // nobody has seen these outlines
            all.push_back({one.mask, std::move(outlines), false});
        }
    for (DerivedStructure& one : derived) {
        one.outlines.attributes = derived_attributes(one);
        all.push_back({std::move(one.mask), std::move(one.outlines), true});
    }
    for (std::size_t n = 0; n < all.size(); ++n)
        if (auto& color = all[n].outlines.attributes.color; !color) color = structure_color(n);
    for (const std::string& words : command.types) {
        const auto [name, type] = named_type(words);
        const auto found = std::find_if(all.begin(), all.end(), [&, &its_name = name](const DeriveOutput& one) {
            return one.outlines.name == its_name;
        });
        if (found == all.end()) refuse(fmt::format("--type is for '{}', which is not written", name));
        found->outlines.attributes.interpreted_type = type;
    }
    return all;
}

std::vector<std::string> write_derived(const fs::path& path, const DeriveCommand& command,
                                       const std::vector<DeriveOutput>& all, const Provenance& provenance,
                                       const Work& work) {
    if (has_extension(path, ".json")) {
        kontur::write_contours(path, all.front().outlines, provenance);
        return {};
    }
    if (!has_room_for_overlap(path)) return write_map(path, all, provenance);
    std::vector<std::string> notes;
    const Structures structures = structures_of(all, notes);
    for (const std::string& note : write_structures({path, command.image, command.series, provenance}, structures, work))
        notes.push_back(note);
    return notes;
}

std::vector<std::string> write_derived_rtstruct(const fs::path& path, const DeriveCommand& command,
                                                const std::vector<DeriveOutput>& all, const Provenance& provenance) {
    std::vector<std::string> notes;
    std::vector<ContourSet> sets;
    for (const DeriveOutput& one : all) {
        if (one.outlines.contours.empty())
            notes.push_back(fmt::format("'{}' has no contours and is no ROI", one.outlines.name));
        else sets.push_back(one.outlines);
    }
    if (sets.empty()) refuse("no structure has a contour, and an RTSTRUCT needs at least 1 that has");
    for (const std::string& note :
         write_contours_of_all(path, sets, command.image, rtstruct_options(command.holes, command.series, provenance)))
        notes.push_back(note);
    return notes;
}

void write_relations(const fs::path& path, const std::vector<StructureRelation>& relations) {
    std::string text =
        "a,b,volume_a_ml,volume_b_ml,overlap_ml,least_distance_mm,a_beyond_b_mm,a_beyond_b_x,a_beyond_b_y,a_beyond_b_z,"
        "b_beyond_a_mm,b_beyond_a_x,b_beyond_a_y,b_beyond_a_z\n";
    for (const StructureRelation& one : relations)
        text += fmt::format(
            "{},{},{:.4g},{:.4g},{:.4g},{},{},{}\n", cell(one.a), cell(one.b), one.volume_a_ml, one.volume_b_ml,
            one.overlap_ml, one.least_distance_mm ? fmt::format("{:.4g}", *one.least_distance_mm) : "",
            farthest_cells(one.a_beyond_b_mm, one.a_beyond_b), farthest_cells(one.b_beyond_a_mm, one.b_beyond_a));
    write_file_atomically(path, text);
}

}  // namespace kontur::app
