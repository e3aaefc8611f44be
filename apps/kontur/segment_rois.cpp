// SPDX-License-Identifier: Apache-2.0
#include "segment_rois.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "dicom_output.h"
#include "facts.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/io/atomic_file.h"
#include "kontur/labels/section_contours.h"
#include "kontur/measure/components.h"
#include "kontur/report.h"
#include "kontur/segment_together.h"
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

/// All ROIs by their numbers, as names may occur twice.
std::vector<std::string> names_of(const SegmentCommand& command, const StructureSet& set) {
    if (!command.all_rois) return command.rois;
    std::vector<std::string> names;
    for (const Roi& roi : set.rois)
        if (!roi.contours.contours.empty() || !roi.damage.empty()) names.push_back(std::to_string(roi.number));
    if (names.empty())
        refuse(fmt::format("{}: none of the {} ROIs has a contour", command.contours.front().string(), set.rois.size()));
    return names;
}

Drawings read_drawings(const SegmentCommand& command, const Progress& progress) {
    const fs::path& file = command.contours.front();
    const StructureSet set = read_rtstruct(file);
    Drawings drawings{{}, {}, {}, set.notes};
    for (const std::string& name : names_of(command, set)) {
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
            if (labels_[n] == 0) {
                labels_[n] = label;
            } else if (inner_.contains({label, labels_[n]})) {
                ++shared_[{label, labels_[n]}];
                labels_[n] = label;
            } else {
                ++shared_[{labels_[n], label}];
            }
        }
        most_ = std::max(most_, label);
    }

    /// The first label lies inside the second: its voxels are its own.
    void set_inside(std::uint16_t inner, std::uint16_t outer) { inner_.insert({inner, outer}); }

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
    std::set<std::pair<std::uint16_t, std::uint16_t>> inner_;
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

/// The borders of a mask on its slices, where no function says where they run.
ContourSet slice_outlines(const Mask& mask) {
    ContourSet set;
    const auto area = static_cast<std::size_t>(mask.grid.size.i * mask.grid.size.j);
    for (std::int64_t k = 0; k < mask.grid.size.k; ++k) {
        const auto first = mask.values.begin() + static_cast<std::ptrdiff_t>(mask.grid.offset(0, 0, k));
        const PaintedSlice slice{
            .axis = 2, .index = k, .whole = true, .section = {first, first + static_cast<std::ptrdiff_t>(area)}};
        std::vector<Contour> contours = section_contours(mask.grid, slice);
        std::move(contours.begin(), contours.end(), std::back_inserter(set.contours));
    }
    return set;
}

/// What is said about a structure beside its voxels, which go to `mask`.
Fitted fitted_from(const SegmentCommand& command, const Drawings& drawings, std::size_t n, Segmentation result, Mask& mask,
                   const Progress& progress) {
    const Roi& roi = drawings.rois[n];
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
        fitted.roi.contours = command.together
                                  ? slice_outlines(result.mask)
                                  : slice_contours(result.mask, result.function, command.options.threads, progress);
        fitted.roi.contours.name = roi.name;
    }
    mask = std::move(result.mask);
    return fitted;
}

/// Masks and volumes as they are after voxels have changed hands.
void count_again(SegmentReport& report, const Mask& mask) {
    report.mask_voxels = std::count(mask.values.begin(), mask.values.end(), 1);
    report.mask_volume_ml = static_cast<double>(report.mask_voxels) * mask.grid.voxel_volume_mm3() / 1000;
    report.mask_components = static_cast<std::int64_t>(component_sizes(mask).size());
}

/// All structures at once; `notes` says what they are to each other.
std::vector<Segmentation> fit_together(const SegmentCommand& command, const Drawings& drawings, LabelMap& labels,
                                       std::vector<std::string>& notes, const Progress& progress) {
    std::vector<ContourSet> contours;
    for (const Roi& roi : drawings.rois) contours.push_back(roi.contours);
    Together all = segment_together(contours, drawings.grid, {.segment = command.options}, progress);
    for (Segmentation& one : all.structures) count_again(one.report, one.mask);
    for (const StructurePair& pair : all.pairs) {
        if (pair.relation == Relation::inside) {
            const auto voxels = [&](std::size_t n) { return all.structures[n].report.mask_voxels; };
            const auto [inner, outer] =
                std::minmax(pair.first, pair.second, [&](auto a, auto b) { return voxels(a) < voxels(b); });
            labels.set_inside(static_cast<std::uint16_t>(inner + 1), static_cast<std::uint16_t>(outer + 1));
        }
        notes.push_back(fmt::format("'{}' and '{}': {}, {} voxel{} claimed by both", drawings.rois[pair.first].name,
                                    drawings.rois[pair.second].name, name(pair.relation), pair.shared_voxels,
                                    pair.shared_voxels == 1 ? "" : "s"));
    }
    notes.push_back(fmt::format("{} voxels between structures that touch were given to the nearest", all.closed_voxels));
    return std::move(all.structures);
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

bool has_several(const SegmentCommand& command) { return command.all_rois || command.rois.size() > 1; }

void check_roi_words(const SegmentCommand& command) {
    const auto refuse_one = [](const char* option) {
        refuse(fmt::format("{} has room for one structure; several ROIs go into a mask's labels and an RTSTRUCT", option));
    };
    if (!command.mesh.empty()) refuse_one("--mesh");
    if (!command.picture.empty()) refuse_one("--picture");
    if (!command.uncertainty.empty()) refuse_one("--uncertainty");
    if (!command.name.empty()) refuse_one("--name");
    if (command.mask.label_value != WriteMaskOptions{}.label_value)
        refuse("--label-value is for one structure; several ROIs become the labels 1, 2, ...");
    if (command.together && command.options.use_image != UseImage::off)
        refuse("--together does not ask the image yet; leave out --use-image auto or --together");
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
    std::vector<std::string> notes = drawings.notes;
    std::vector<Segmentation> parted;
    if (command.together) parted = fit_together(command, drawings, labels, notes, progress);
    for (std::size_t n = 0; n < drawings.rois.size(); ++n) {
        Mask mask;
        try {
            Segmentation result = command.together
                                      ? std::move(parted[n])
                                      : segment(drawings.rois[n].contours, drawings.grid,
                                                drawings.image ? &*drawings.image : nullptr, command.options, progress);
            all.push_back(fitted_from(command, drawings, n, std::move(result), mask, progress));
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
