// SPDX-License-Identifier: Apache-2.0
#include "fill_structures.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dicom_output.h"
#include "kontur/base/error.h"
#include "kontur/io/image.h"

namespace kontur::app {
namespace {

/// The chosen ones.
Structures structures_of(const ImageInput& input, const std::vector<std::int64_t>& chosen, const Work& work) {
    Structures all = read_structures(input, work), some;
    if (chosen.empty()) return all;
    const auto is_chosen = [&](std::int64_t number) {
        return std::find(chosen.begin(), chosen.end(), number) != chosen.end();
    };
    for (std::size_t n = 0; n < all.segments.size(); ++n) {
        if (!is_chosen(all.segments[n].number)) continue;
        some.segments.push_back(std::move(all.segments[n]));
        some.masks.push_back(std::move(all.masks[n]));
        if (n < all.tags.size()) some.tags.push_back(std::move(all.tags[n]));
    }
    for (const std::int64_t number : chosen)
        if (std::none_of(some.segments.begin(), some.segments.end(), [&](const auto& s) { return s.number == number; }))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the label {} is to be filled, but no segment has it", number));
    return some;
}

}  // namespace

FilledStructures fill_structures(const ImageInput& input, const Image* image, const FillOptions& options, const Work& work) {
    FilledStructures filled{structures_of(input, options.labels, work), {}};
    FillOptions each = options;
    each.labels.clear();
    for (std::size_t n = 0; n < filled.structures.masks.size(); ++n) {
        const DicomSegment& segment = filled.structures.segments[n];
        Mask& mask = filled.structures.masks[n];
        try {
            Filling one = fill_labels({mask.grid, std::move(mask.values)}, image, each, work);
            mask.values = std::move(std::get<std::vector<std::uint8_t>>(one.labels.samples));
            one.report.labels.front().label = segment.number;
            filled.report.labels.push_back(std::move(one.report.labels.front()));
            for (auto& stage : one.report.seconds) filled.report.seconds.push_back(std::move(stage));
        } catch (const Error& error) {
            throw error.with_context(fmt::format("segment '{}'", segment.label));
        }
    }
    return filled;
}

void check_room_for_overlap(const FillCommand& command) {
    if (has_room_for_overlap(command.output) || command.options.labels.size() == 1) return;
    throw Error(ErrorKind::invalid_input,
                fmt::format("segments of {} overlap, and {} has room for one in a voxel; write a SEG (.dcm) or "
                            ".seg.nrrd, or choose one with the option label",
                            command.labels.path.string(), command.output.string()));
}

std::vector<std::string> write_filled(const OutputFile& file, const FilledStructures& filled, const Work& work) {
    const std::filesystem::path& path = file.path;
    if (is_dicom_name(path) || (has_room_for_overlap(path) && filled.structures.segments.size() > 1))
        return write_structures(file, filled.structures, work);
    const DicomSegment& segment = filled.structures.segments.front();
    const LabelName name{segment.number, segment.label, to_levels(segment.color.value_or(kStructureColor)),
                         tags_of(filled.structures, 0)};
    kontur::write_image(path, label_map(filled.structures.masks.front(), segment.number), {name}, file.provenance);
    return {};
}

}  // namespace kontur::app
