// SPDX-License-Identifier: Apache-2.0
#include "segment_rois.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "dicom_output.h"
#include "facts.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/io/atomic_file.h"
#include "kontur/report.h"
#include "kontur/view/picture.h"
#include "outputs.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

/// Colours of structures whose ROI has none.
constexpr std::array<std::array<std::uint8_t, 3>, 6> kColors{
    {{230, 179, 77}, {77, 153, 230}, {102, 191, 102}, {217, 102, 102}, {166, 128, 204}, {128, 204, 204}}};

/// What is read once for all ROIs.
struct Drawings {
    std::vector<Roi> rois;  ///< as named
    Grid grid;
    std::optional<Image> image;  ///< only where its voxels matter
    std::vector<std::string> notes;
};

Drawings read_drawings(const SegmentCommand& command, const Progress& progress) {
    const fs::path& file = command.contours.front();
    const StructureSet set = read_rtstruct(file);
    Drawings drawings{{}, {}, {}, set.notes};
    for (const std::string& name : command.rois) {
        try {
            const Roi roi = select_roi(set, name);
            if (roi.contours.contours.empty())
                refuse(fmt::format("the ROI '{}' has no contour; at least 1 is needed", name));
            for (const Roi& other : drawings.rois)
                if (other.number == roi.number) refuse(fmt::format("the ROI '{}' is named twice", name));
            drawings.rois.push_back(roi);
        } catch (const Error& error) {
            throw error.with_context(file.string());
        }
    }
    for (std::string& note : frame_of_reference_notes(drawings.rois.front().frame_of_reference_uid, command.image))
        drawings.notes.push_back(std::move(note));
    ReadImageOptions read = command.image.options;
    read.on_note = [&](std::string_view note) { drawings.notes.emplace_back(note); };
    if (command.options.use_image == UseImage::off) {
        drawings.grid = read_grid(command.image.path, read, progress);
    } else {
        drawings.image = read_image(command.image.path, read, progress);
        drawings.grid = drawings.image->grid;
    }
    return drawings;
}

/// What one fit leaves.
struct Fitted {
    DicomSegment segment;
    Roi roi;  ///< the surface on the slices, where an RTSTRUCT is asked for
    SegmentReport report;
    Provenance made;
};

/// The voxels of all structures so far.
class LabelMap {
public:
    explicit LabelMap(const Grid& grid) : grid_(grid), labels_(static_cast<std::size_t>(grid.voxel_count())) {}

    void add(const Mask& mask, std::uint16_t label) {
        for (std::size_t n = 0; n < labels_.size(); ++n) {
            if (mask.values[n] == 0) continue;
            if (labels_[n] == 0) labels_[n] = label;
            else ++shared_[{labels_[n], label}];
        }
        most_ = std::max(most_, label);
    }

    /// In 8 bits where they suffice.
    Image image() const {
        if (most_ > std::numeric_limits<std::uint8_t>::max()) return {grid_, labels_};
        return {grid_, std::vector<std::uint8_t>(labels_.begin(), labels_.end())};
    }

    std::vector<std::string> notes(const std::vector<Fitted>& all) const {
        std::vector<std::string> notes;
        const auto name = [&](std::uint16_t label) { return all[label - 1u].segment.label; };
        for (const auto& [labels, voxels] : shared_)
            notes.push_back(
                fmt::format("{} voxel{} of '{}' lie{} in '{}', too, and keep{} its label {}; a DICOM SEG (.dcm) has room "
                            "for both",
                            voxels, voxels == 1 ? "" : "s", name(labels.second), voxels == 1 ? "s" : "", name(labels.first),
                            voxels == 1 ? "s" : "", labels.first));
        return notes;
    }

private:
    Grid grid_;
    std::vector<std::uint16_t> labels_;
    std::uint16_t most_ = 0;
    std::map<std::pair<std::uint16_t, std::uint16_t>, std::int64_t> shared_;
};

/// What all fits say once, what differs with the label's number behind its name.
Provenance together(const std::vector<Fitted>& all) {
    Provenance made = all.front().made;
    Provenance others;
    for (auto& [name, value] : made) {
        const auto same = [&, &name = name, &value = value](const Fitted& one) {
            return std::find(one.made.begin(), one.made.end(), std::pair{name, value}) != one.made.end();
        };
        if (std::all_of(all.begin(), all.end(), same)) continue;
        for (std::size_t n = 0; n < all.size(); ++n)
            for (const auto& [its_name, its_value] : all[n].made)
                if (its_name == name) others.emplace_back(fmt::format("{}_{}", name, n + 1), its_value);
        name.clear();
    }
    std::erase_if(made, [](const auto& entry) { return entry.first.empty(); });
    made.insert(made.end(), others.begin(), others.end());
    return made;
}

Fitted fit(const SegmentCommand& command, const Drawings& drawings, std::size_t n, Mask& mask, const Progress& progress) {
    const Roi& roi = drawings.rois[n];
    Segmentation result = segment(roi.contours, drawings.grid, drawings.image ? &*drawings.image : nullptr, command.options, progress);
    Fitted fitted;
    fitted.segment = {.number = static_cast<std::int64_t>(n + 1),
                      .label = roi.name,
                      .algorithm_name = "kontur",
                      .color = roi.color.value_or(kColors[n % kColors.size()])};
    fitted.made = provenance(roi.contours, drawings.grid, result.report);
    fitted.report = std::move(result.report);
    fitted.report.warnings.insert(fitted.report.warnings.begin(), roi.notes.begin(), roi.notes.end());
    if (!command.rtstruct.empty()) {
        fitted.roi.name = roi.name;
        fitted.roi.interpreted_type = roi.interpreted_type;
        fitted.roi.color = fitted.segment.color;
        fitted.roi.generation_algorithm = "SEMIAUTOMATIC";
        fitted.roi.contours = slice_contours(result.mask, result.function, command.options.threads, progress);
        fitted.roi.contours.name = roi.name;
    }
    mask = std::move(result.mask);
    return fitted;
}

Facts report_of(const std::vector<Fitted>& all, const std::vector<std::string>& notes, const Provenance& made) {
    Facts structures = Facts::array();
    for (const Fitted& one : all) {
        Facts facts{{"label", one.segment.number}, {"name", one.segment.label}};
        facts.update(Facts::parse(kontur::to_json(one.report, one.made)));
        structures.push_back(std::move(facts));
    }
    Facts provenance = Facts::object();
    for (const auto& [name, value] : made) provenance[name] = value;
    return {{"version", KONTUR_VERSION}, {"provenance", provenance}, {"structures", structures}, {"warnings", notes}};
}

std::vector<std::string> write_labels(const fs::path& path, const LabelMap& labels, const std::vector<Fitted>& all,
                                      const Provenance& made) {
    std::vector<LabelName> names;
    for (const Fitted& one : all) {
        const auto& color = *one.segment.color;
        names.push_back({one.segment.number, one.segment.label, {color[0] / 255.0, color[1] / 255.0, color[2] / 255.0}});
    }
    kontur::write_image(path, labels.image(), {names, made});
    return labels.notes(all);
}

std::vector<std::string> write_rois(const fs::path& path, const SegmentCommand& command, const std::vector<Fitted>& all,
                                    const Provenance& made) {
    StructureSet set{"kontur", {}};
    for (const Fitted& one : all) set.rois.push_back(one.roi);
    const DicomSeries series = read_dicom_grid(command.image.path, command.image.options.dicom).series;
    return write_rtstruct(path, set, series, rtstruct_options(command.holes, made));
}

}  // namespace

void check_roi_words(const SegmentCommand& command) {
    const auto refuse_one = [](const char* option) {
        refuse(fmt::format("{} has room for one structure; several ROIs go into a mask's labels and an RTSTRUCT", option));
    };
    if (!command.mesh.empty()) refuse_one("--mesh");
    if (!command.picture.empty()) refuse_one("--picture");
    if (!command.name.empty()) refuse_one("--name");
    if (command.mask.label_value != WriteMaskOptions{}.label_value)
        refuse("--label-value is for one structure; several ROIs become the labels 1, 2, ...");
    if (command.image.path.empty()) refuse("several ROIs need an --image, whose grid is that of their label map");
    if (command.contours.size() != 1) refuse("several ROIs are chosen from one RTSTRUCT");
    if (command.rois.size() > std::numeric_limits<std::uint16_t>::max())
        throw Error(ErrorKind::too_large,
                    fmt::format("{} ROIs are named; a label map has room for 65535", command.rois.size()));
}

void segment_rois(const SegmentCommand& command, Console& console) {
    const Progress progress = console.progress();
    const Drawings drawings = read_drawings(command, progress);
    const bool is_seg = is_dicom_name(command.output);
    std::vector<Fitted> all;
    Structures structures;  // of a SEG, which keeps all voxels
    LabelMap labels(drawings.grid);
    for (std::size_t n = 0; n < drawings.rois.size(); ++n) {
        Mask mask;
        try {
            all.push_back(fit(command, drawings, n, mask, progress));
        } catch (const Error& error) {
            throw error.with_context(fmt::format("ROI '{}'", drawings.rois[n].name));
        }
        if (!is_seg) {
            labels.add(mask, static_cast<std::uint16_t>(n + 1));
            continue;
        }
        structures.segments.push_back(all.back().segment);
        structures.masks.push_back(std::move(mask));
    }

    Provenance made = together(all);
    for (auto& digest : input_digests(command, progress)) made.push_back(std::move(digest));
    if (command.date) made.emplace_back("date", utc_date());

    std::vector<std::string> notes = drawings.notes;
    const auto add = [&](std::vector<std::string> more) { notes.insert(notes.end(), more.begin(), more.end()); };
    Outputs outputs;
    outputs.write(command.output, [&](const fs::path& path) {
        add(is_seg ? write_structures(path, structures, command.image, made, progress)
                   : write_labels(path, labels, all, made));
    });
    if (!command.rtstruct.empty())
        outputs.write(command.rtstruct, [&](const fs::path& path) { add(write_rois(path, command, all, made)); });
    if (!command.report.empty())
        outputs.write(command.report,
                      [&](const fs::path& path) { write_file_atomically(path, to_json_text(report_of(all, notes, made))); });
    outputs.commit();

    for (const Fitted& one : all)
        for (const std::string& warning : one.report.warnings)
            console.warn(fmt::format("{}: {}", one.segment.label, warning));
    for (const std::string& note : notes) console.warn(note);
    std::string text = fmt::format("{}: {} structures\n", command.output.string(), all.size());
    for (const Fitted& one : all)
        text += fmt::format("{} {}: {} voxels, {}; residual {:.3g} mm (max)\n", one.segment.number, one.segment.label,
                            one.report.mask_voxels, in_ml(one.report.mask_volume_ml), one.report.residual.max_mm);
    for (const fs::path& path : {command.rtstruct, command.report})
        if (!path.empty()) text += path.string() + "\n";
    console.print(text);
}

}  // namespace kontur::app
