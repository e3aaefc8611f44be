// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/structure_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/image/intensities.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/dicom/derived_segment.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"
#include "kontur/io/image_frames.h"
#include "kontur/io/images/nrrd.h"
#include "kontur/io/images/segment_tags.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/labels/section_contours.h"
#include "kontur/segment_together.h"
#include "viewer/files/zip.h"
#include "viewer/model/file_names.h"
#include "viewer/model/label_values.h"
#include "viewer/model/temporary_files.h"
#include "viewer/surfaces/border_sharing.h"
#include "viewer/surfaces/corrected_mask.h"
#include "viewer/surfaces/mask_neighbors.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using All = std::vector<FittedStructure>;

std::int64_t voxels_of(const Mask& mask) { return std::accumulate(mask.values.begin(), mask.values.end(), std::int64_t{0}); }

/// From the largest to the smallest, by place in the list.
std::vector<std::size_t> by_size(const All& all) {
    std::vector<std::int64_t> voxels;
    for (const FittedStructure& one : all) voxels.push_back(voxels_of(one.segmentation.mask));
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return voxels[a] > voxels[b]; });
    return order;
}

std::vector<std::int64_t> label_values_of(const All& all) {
    std::vector<std::optional<std::int64_t>> own;
    for (const FittedStructure& one : all) own.push_back(one.structure.label_value);
    return label_values(own);
}

/// 1, 2, ...
std::vector<std::int64_t> places_of(const All& all) {
    std::vector<std::int64_t> places(all.size());
    std::iota(places.begin(), places.end(), std::int64_t{1});
    return places;
}

/// How the structures were made; what differs has the label's number behind its name.
Provenance together(const All& all, const std::vector<std::int64_t>& numbers) {
    Provenance provenance;
    for (std::size_t n = 0; n < all.size(); ++n)
        for (const auto& [name, value] : provenance_of(all[n])) {
            const std::pair entry{name, value};
            if (n == 0 && std::all_of(all.begin(), all.end(), [&](const FittedStructure& one) {
                    const Provenance its = provenance_of(one);
                    return std::find(its.begin(), its.end(), entry) != its.end();
                }))
                provenance.push_back(entry);
            else if (std::find(provenance.begin(), provenance.end(), entry) == provenance.end())
                provenance.emplace_back(fmt::format("{}_{}", name, numbers[n]), value);
        }
    return provenance;
}

/// On layers, where voxels lie in several.
void write_layers(const fs::path& path, const All& all) {
    std::vector<Mask> masks;
    std::vector<NrrdSegment> segments;
    const std::vector<std::int64_t> values = label_values_of(all);
    for (const FittedStructure& one : all) {
        masks.push_back(one.segmentation.mask);
        segments.push_back(
            {.name = one.structure.name, .color = rgb(one.structure.color), .label_value = values[segments.size()]});
        segments.back().tags = tags_of_terms(one.set.attributes);
    }
    write_seg_nrrd_masks(path, masks, segments, together(all, values));
}

/// Who made the mask, and what corrected it, if anything did.
void name_source(DicomSegment& segment, const FittedStructure& one) {
    constexpr std::size_t kMostBytes = 64;
    const std::string& source = one.structure.mask->source;
    const std::string own = one.set.attributes.generation_algorithm;
    if (one.corrected->report.dice == 1) {
        segment.algorithm_name = source;
        if (!own.empty()) segment.algorithm_type = own;
        return;
    }
    const std::string both = source + " + kontur correct";
    segment.algorithm_type = "SEMIAUTOMATIC";
    segment.algorithm_name = source.empty() || both.size() > kMostBytes ? "kontur correct" : both;
}

std::vector<std::string> write_seg(const fs::path& path, const All& all, const DicomSeries& images, const Work& work) {
    std::vector<Mask> masks;
    std::vector<DicomSegment> segments;
    for (const FittedStructure& one : all) {
        masks.push_back(one.segmentation.mask);
        segments.push_back((one.is_derived ? derived_segment : fitted_segment)(one.set.attributes));
        segments.back().number = static_cast<std::int64_t>(segments.size());
        segments.back().label = one.structure.name;
        if (one.corrected) name_source(segments.back(), one);
    }
    return write_dicom_seg_masks(
        path, {masks, segments}, images,
        {.algorithm = {"kontur variational interpolation", KONTUR_VERSION, ""}, .provenance = together(all, places_of(all))},
        work);
}

std::vector<std::string> write_regions(const fs::path& path, const All& all, const DicomSeries& images, const Work& work) {
    StructureSet set{"kontur", {}};
    std::vector<std::string> notes;
    for (const FittedStructure& one : all) {
        Roi roi;
        roi.name = one.structure.name;
        if (one.is_derived) {
            roi.contours = one.set;
            if (roi.contours.contours.empty()) notes.push_back(fmt::format("'{}' has no contours and is no ROI", roi.name));
            else set.rois.push_back(std::move(roi));
            continue;
        }
        roi.contours = one.shares_border || one.corrected
                           ? slice_outlines(one.segmentation.mask)
                           : slice_contours(one.segmentation.mask, one.segmentation.function, work);
        roi.contours.name = one.structure.name;
        roi.contours.attributes = fitted_attributes(one.set.attributes);
        roi.contours.attributes.review = one.set.attributes.review;  // of what is seen in the page, and written here
        set.rois.push_back(std::move(roi));
    }
    WriteRtstructOptions options;
    options.provenance = together(all, places_of(all));
    for (std::string& note : write_rtstruct(path, set, images, options)) notes.push_back(std::move(note));
    return notes;
}

/// "meshes.stl.zip": one .stl for each structure, by its name; those of one name get a number.
void write_meshes(const fs::path& path, std::string_view name, const All& all) {
    const std::string ending(name.substr(name.find('.'), name.rfind('.') - name.find('.')));
    const TemporaryFolder folder;
    std::vector<ZipEntry> entries;
    for (const FittedStructure& one : all) {
        std::string stem = plain_name(one.structure.name);
        const auto is_taken = [&](const std::string& file) {
            return std::any_of(entries.begin(), entries.end(), [&](const ZipEntry& e) { return e.name == file; });
        };
        for (int number = 2; is_taken(stem + ending); ++number)
            stem = fmt::format("{}_{}", plain_name(one.structure.name), number);
        const fs::path file = folder.path() / (stem + ending);
        write_mesh(file, *one.segmentation.mesh, provenance_of(one));
        entries.push_back({stem + ending, read_bytes(file)});
    }
    write_file_atomically(path, zip(entries));
}

const DicomSeries& series_of(const std::optional<DicomSeries>& images, std::string_view name) {
    if (images) return *images;
    throw Error(ErrorKind::invalid_input,
                fmt::format("{} would refer to the DICOM images it was made on, and this image is none", name));
}

/// The surfaces with their borders, on a lattice that does not depend on the image's slices; `pairs` as the masks have them.
/// The functions have borrowed their neighbours' borders already.
void share_surfaces(std::vector<FittedStructure>& all, const std::vector<StructurePair>& pairs, const Work& work) {
    std::vector<LoneSurface> alone;
    for (const FittedStructure& one : all)
        if (!one.segmentation.mesh->triangles.empty())
            alone.push_back({one.structure.id, std::make_shared<const ContourSet>(one.set), one.segmentation.function,
                             std::make_shared<const TriangleMesh>(*one.segmentation.mesh)});
    Borders borders{.shared = true};
    for (const StructurePair& pair : pairs)
        if (pair.is_given || pair.relation != Relation::inside)
            borders.set({all[pair.first].structure.id, all[pair.second].structure.id, pair.relation});
    const SharedBorders found = BorderSharing().share(alone, borders, work);
    for (FittedStructure& one : all)
        if (const auto mesh = found.meshes.find(one.structure.id); mesh != found.meshes.end())
            one.segmentation.mesh = *mesh->second;
}

/// Null where the image is not to be asked.
const Image* image_to_use(const State& state, const Image& image) { return state.use_image ? &image : nullptr; }

/// Whether `segment` makes a mask of the contours on this grid.
bool reaches_into(const Grid& grid, const ContourSet& set) {
    try {
        check_contours_inside(set, grid);
        return true;
    } catch (const Error&) {
        return false;
    }
}

/// Where masks are asked for, and whether surfaces are, too.
struct ExportTarget {
    const Image& image;
    const Grid& grid;
    bool mesh;
};

/// A mask with its corrections, by itself, on its own grid.
FittedStructure corrected(const State& state, const Structure& structure, const ExportTarget& target, const Work& work) {
    FittedStructure one{structure, contour_set(state, structure.id), {}, false, {}};
    try {
        const Mask before = mask_of(state, structure)->mask();
        const Image* image = image_to_use(state, target.image);
        if (image && is_label_map(*image)) image = nullptr;
        one.corrected = std::make_shared<const CorrectedMask>(correct({before, ExistingSurface(before, work), image},
                                                                      corrections_of(one.set, *structure.mask),
                                                                      correct_options(*structure.mask), work));
        if (const auto kept = kept_mask_of(state, structure))
            one.corrected = std::make_shared<const CorrectedMask>(
                as_kept(CorrectedMask(*one.corrected), *mask_of(state, structure), *kept));
    } catch (const Error& error) {
        throw Error(error.kind(), fmt::format("{}: {}", structure.name, error.what()));
    }
    return one;
}

/// Each of them follows what the corrections of others mean to it.
void share_mask_borders(std::vector<FittedStructure>& masks, const State& state, const Work& work) {
    const auto stored = [&](const FittedStructure& one) { return mask_of(state, one.structure); };
    MaskExchanges exchanges;
    for (const FittedStructure& one : masks) {
        MaskExchange exchange = exchange_of(stored(one)->mask(), made_voxels(*one.corrected), work);
        exchange.kept = kept_mask_of(state, one.structure);
        exchanges.push_back(std::make_shared<const MaskExchange>(std::move(exchange)));
    }
    for (FittedStructure& one : masks) {
        if (kept_mask_of(state, one.structure)) continue;
        MaskExchanges others;
        for (std::size_t n = 0; n < masks.size(); ++n) {
            const BorderRule* rule = state.borders.rule_about(one.structure.id, masks[n].structure.id);
            if (&masks[n] != &one && may_share(rule, *stored(one), *stored(masks[n]))) others.push_back(exchanges[n]);
        }
        one.corrected =
            std::make_shared<const CorrectedMask>(after_others(CorrectedMask(*one.corrected), *stored(one), others));
    }
}

std::vector<FittedStructure> corrected_masks(const State& state, const ExportTarget& target, const Work& work) {
    std::vector<FittedStructure> masks;
    for (const auto& [id, structure] : state.structures)
        if (structure.mask) masks.push_back(corrected(state, structure, target, work));
    if (state.borders.shared && masks.size() > 1) share_mask_borders(masks, state, work);
    for (FittedStructure& one : masks) {
        one.segmentation.mask = on_grid(one.corrected->mask, target.grid, work);
        if (target.mesh) one.segmentation.mesh = mesh_of(one.corrected->mask, work);
    }
    return masks;
}

/// Adds the masks that are to be corrected, each at its place.
void add_corrected(std::vector<FittedStructure>& all, const State& state, const ExportTarget& target, const Work& work) {
    for (FittedStructure& one : corrected_masks(state, target, work)) all.push_back(std::move(one));
    std::ranges::sort(all, {}, [](const FittedStructure& one) { return one.structure.id; });
}

std::vector<FittedStructure> fit_together(const State& state, const Image& image, const Grid& grid, bool with_mesh,
                                          const Work& work) {
    std::vector<FittedStructure> all;
    std::vector<ContourSet> sets;
    std::vector<Id> ids;
    for (const auto& [id, structure] : state.structures) {
        ContourSet set = contour_set(state, id);
        if (set.contours.empty() || structure.mask) continue;
        sets.push_back(set);
        ids.push_back(id);
        all.push_back({structure, std::move(set), {}});
    }
    if (all.empty()) return all;
    TogetherOptions options;
    options.segment.mesh = with_mesh;
    options.segment.drawn_on = image.grid;
    for (const FittedStructure& one : all) options.smoothing.push_back(one.structure.smoothing);
    options.rules = rules_among(state.borders, ids);
    Together together = segment_together(sets, grid, image_to_use(state, image), options, work);
    for (std::size_t n = 0; n < all.size(); ++n) {
        Mask whole = whole_mask(together, n);
        all[n].segmentation = std::move(together.structures[n]);
        all[n].segmentation.mask = std::move(whole);
    }
    for (const StructurePair& pair : together.pairs)
        if (pair.relation == Relation::exclusive || (pair.relation == Relation::inside && pair.is_given))
            all[pair.first].shares_border = all[pair.second].shares_border = true;
    if (with_mesh) share_surfaces(all, together.pairs, work);
    return all;
}

std::vector<FittedStructure> fit_each(const State& state, const Image& image, const Grid& grid, bool with_mesh,
                                      const Work& work) {
    std::vector<FittedStructure> all;
    for (const auto& [id, structure] : state.structures) {
        ContourSet set = contour_set(state, id);
        if (set.contours.empty() || structure.mask) continue;
        const SegmentOptions options{.smoothing = structure.smoothing, .mesh = with_mesh, .drawn_on = image.grid};
        try {
            Segmentation segmentation = segment(set, grid, image_to_use(state, image), options, work);
            all.push_back({structure, std::move(set), std::move(segmentation)});
        } catch (const Error& error) {
            throw Error(error.kind(), fmt::format("{}: {}", structure.name, error.what()));
        }
    }
    return all;
}

}  // namespace

std::vector<FittedStructure> fit_structures(const State& state, const Image& image, bool with_mesh, const Work& work) {
    auto all = (state.borders.shared ? fit_together : fit_each)(state, image, image.grid, with_mesh, work);
    add_corrected(all, state, {image, image.grid, with_mesh}, work);
    if (all.empty()) throw Error(ErrorKind::invalid_input, "no structure has contours");
    return all;
}

std::vector<FittedStructure> fit_structures_on(const Grid& grid, const State& state, const Image& image, const Work& work) {
    State within = state;
    for (const auto& found : state.structures)
        if (!reaches_into(grid, contour_set(state, found.first)))
            std::erase_if(within.contours, [&](const auto& item) { return item.second->structure == found.first; });
    auto all = (state.borders.shared ? fit_together : fit_each)(within, image, grid, false, work);
    add_corrected(all, state, {image, grid, false}, work);
    std::erase_if(all, [](const FittedStructure& one) { return one.corrected && voxels_of(one.segmentation.mask) == 0; });
    return all;
}

FittedStructure fit_structure(const State& state, Id structure, const Image& image, bool with_mesh, const Work& work) {
    if (structure_of(state, structure).mask) {
        State masks = state;
        if (!state.borders.shared) std::erase_if(masks.structures, [&](const auto& one) { return one.first != structure; });
        std::vector<FittedStructure> all = corrected_masks(masks, {image, image.grid, with_mesh}, work);
        return std::move(*std::ranges::find(all, structure, [](const FittedStructure& one) { return one.structure.id; }));
    }
    ContourSet set = contour_set(state, structure);
    const bool is_alone = std::all_of(state.contours.begin(), state.contours.end(),
                                      [&](const auto& item) { return item.second->structure == structure; });
    if (!state.borders.shared || is_alone || set.contours.empty()) {
        const SegmentOptions options{
            .smoothing = structure_of(state, structure).smoothing, .mesh = with_mesh, .drawn_on = image.grid};
        Segmentation segmentation = segment(set, image.grid, image_to_use(state, image), options, work);
        return {structure_of(state, structure), std::move(set), std::move(segmentation)};
    }
    std::vector<FittedStructure> all = fit_structures(state, image, with_mesh, work);
    const auto chosen =
        std::find_if(all.begin(), all.end(), [&](const FittedStructure& one) { return one.structure.id == structure; });
    return std::move(*chosen);
}

Provenance provenance_of(const FittedStructure& one) {
    if (one.is_derived)
        return {{"rule", *one.structure.rule}, {"outlines_sha256", contours_sha256(one.set)}, {"version", KONTUR_VERSION}};
    if (!one.corrected) return provenance(one.set, one.segmentation.mask.grid, one.segmentation.report);
    const StructureMask& mask = *one.structure.mask;
    return {{"mask_sha256", mask.hash},
            {"contours_sha256", contours_sha256(one.set)},
            {"version", KONTUR_VERSION},
            {"options", fmt::format("correct reach={} drop_loose={} confirmed={} image={}", mask.reach, mask.drop_loose,
                                    mask.confirmed_planes.size(), one.corrected->report.image ? "used" : "none")}};
}

void LabelFrames::add(const All& all) {
    std::vector<std::uint16_t> labels(all.front().segmentation.mask.values.size());  // places in the list, from 1
    for (const std::size_t n : by_size(all)) {
        const std::vector<std::uint8_t>& inside = all[n].segmentation.mask.values;
        for (std::size_t v = 0; v < labels.size(); ++v) {
            if (inside[v] == 0) continue;
            if (labels[v] != 0) ++shared_[{labels[v] - 1u, n}];
            labels[v] = static_cast<std::uint16_t>(n + 1);
        }
    }
    const std::vector<std::int64_t> values = label_values_of(all);
    for (std::uint16_t& label : labels)
        if (label != 0) label = static_cast<std::uint16_t>(values[label - 1u]);
    Image& image = frames_.emplace_back(Image{all.front().segmentation.mask.grid, labels});
    if (std::ranges::max(values) <= 255) image.samples = std::vector<std::uint8_t>(labels.begin(), labels.end());
    if (frames_.size() > 1) return;
    provenance_ = together(all, values);
    for (std::size_t n = 0; n < all.size(); ++n)
        names_.push_back({values[n], all[n].structure.name, rgb(all[n].structure.color)});
}

void LabelFrames::write_first(const fs::path& path) const { write_image(path, frames_.front(), names_, provenance_); }

void LabelFrames::write(const fs::path& path, std::optional<double> step_s) const {
    write_label_maps(path, frames_, step_s, names_, provenance_);
}

std::vector<std::string> LabelFrames::notes() const {
    std::vector<std::string> notes;
    for (const auto& [pair, voxels] : shared_)
        notes.push_back(fmt::format("{} in {} and in {}: in the label map {} to {}, the smaller one",
                                    voxels == 1 ? "1 voxel lies" : counted(voxels, "voxel") + " lie",
                                    names_[pair.first].name, names_[pair.second].name,
                                    voxels == 1 ? "it belongs" : "they belong", names_[pair.second].name));
    return notes;
}

bool is_export_of_all(std::string_view name) {
    return std::find(kExportsOfAll.begin(), kExportsOfAll.end(), name) != kExportsOfAll.end();
}

std::vector<std::string> write_structures(const fs::path& path, std::string_view name, const All& all,
                                          const std::optional<DicomSeries>& images, const Work& work) {
    if (name == "seg.dcm") return write_seg(path, all, series_of(images, name), work);
    if (name == "rtstruct.dcm") return write_regions(path, all, series_of(images, name), work);
    if (name.ends_with(".zip")) return write_meshes(path, name, all), std::vector<std::string>{};
    if (name.ends_with(".seg.nrrd")) return write_layers(path, all), std::vector<std::string>{};
    LabelFrames labels;
    labels.add(all);
    labels.write_first(path);
    return labels.notes();
}

}  // namespace kontur::viewer
