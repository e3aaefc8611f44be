// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/import_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/extract/trace.h"
#include "kontur/io/contours.h"
#include "kontur/io/dicom/dicom_identity.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/dicom/rtstruct_in_time.h"
#include "kontur/io/image.h"
#include "kontur/io/images/nifti_extensions.h"
#include "kontur/io/images/nrrd.h"
#include "kontur/io/images/segment_tags.h"
#include "kontur/segment.h"
#include "kontur/shape/repeated_contours.h"
#include "viewer/images/further_image.h"
#include "viewer/images/views.h"
#include "viewer/model/model.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostImportedLabels = 64;

/// MaskOrigin contours keep what matters of a mask at a tenth of a millimetre; smaller sections are specks.
constexpr TraceOptions kTraceOptions{.step_mm = 0, .tolerance_mm = 0.1, .min_area_mm2 = 4};

/// Planes across `kind`, spread evenly over the mask's extent; a mask has half a step of room beyond the outermost ones.
std::vector<Plane> planes_across(const Mask& mask, SliceKind kind, int count) {
    View view = view_of(mask.grid, kind);
    double from = std::numeric_limits<double>::infinity(), to = -from;
    const Index3& n = mask.grid.size;
    for (std::int64_t k = 0; k < n.k; ++k)
        for (std::int64_t j = 0; j < n.j; ++j)
            for (std::int64_t i = 0; i < n.i; ++i)
                if (mask.values[mask.grid.offset(i, j, k)]) {
                    const double at = view.plane.distance_to(mask.grid.center_mm(i, j, k));
                    from = std::min(from, at), to = std::max(to, at);
                }
    std::vector<Plane> planes;
    for (int i = 0; i < count; ++i) {
        // On the mask's own slices, where its border is not interpolated, and each of them once.
        const double at = from + (to - from) * (i + 0.5) / count;
        Plane plane = view.plane;
        plane.origin += std::round(at / view.step_mm) * view.step_mm * plane.normal;
        if (planes.empty() || distance(planes.back().origin, plane.origin) > 0.5 * view.step_mm) planes.push_back(plane);
    }
    return planes;
}

ContourSet traced(const Mask& mask, const Upload& request) {
    std::vector<Plane> planes;
    const auto add = [&](bool wanted, SliceKind kind) {
        if (!wanted) return;
        const std::vector<Plane> more = planes_across(mask, kind, request.trace.planes);
        planes.insert(planes.end(), more.begin(), more.end());
    };
    add(request.trace.axial, SliceKind::axial);
    add(request.trace.sagittal, SliceKind::sagittal);
    add(request.trace.coronal, SliceKind::coronal);
    return trace(mask, planes, kTraceOptions);
}

/// Somebody approved the outlines, not the surface that is fitted to them here.
void forget_approvals(StructureSet& set, std::vector<std::string>& notes) {
    for (Roi& roi : set.rois) {
        auto& approved = roi.contours.attributes.review.approved;
        if (approved && &roi == &set.rois.front())
            notes.push_back(
                fmt::format("{} approved the outlines of this file; here they are not approved, as kontur makes a "
                            "surface of its own of them",
                            approved->by.empty() ? "Somebody" : approved->by));
        approved.reset();
    }
}

/// The image's frames; empty where it has one, or where they cannot be read any more.
std::vector<DicomSeries> frames_of(const Upload& upload) {
    if (upload.images.empty()) return {};
    try {
        return list_dicom_frames_with(upload.images, upload.series_uid);
    } catch (const Error&) {
        return {};
    }
}

/// Every region that has contours.
ImportContent read_rtstruct_of(const fs::path& path, const Upload& upload) {
    ImportContent imported;
    StructureSet set = read_rtstruct_in_time(path, frames_of(upload));
    imported.notes = std::move(set.notes);
    forget_approvals(set, imported.notes);
    for (Roi& roi : set.rois) {
        if (!roi.damage.empty()) imported.notes.push_back("left out: " + roi.damage);
        for (const std::string& note : roi.notes) imported.notes.push_back(roi.name + ": " + note);
        if (roi.contours.contours.empty()) {
            if (!roi.contours.surface.empty()) imported.notes.push_back(roi.name + ": left out: points without a contour");
            continue;
        }
        if (imported.frame_of_reference_uid.empty()) imported.frame_of_reference_uid = roi.frame_of_reference_uid;
        check_contours(roi.contours);
        imported.sets.push_back(std::move(roi.contours));
    }
    if (imported.sets.empty()) throw Error(ErrorKind::invalid_input, "no region of this structure set has contours");
    return imported;
}

/// Of what is traced: who it is of, and what is said of it.
struct MaskOrigin {
    std::string name;  ///< "" where the file has none
    StructureAttributes attributes{};
    std::optional<std::int64_t> label_value{};
    std::string source{};  ///< what made it, as the file says
};

TracedMask preview_of(const Mask& mask, const ContourSet& set) {
    const double voxel_ml = mask.grid.voxel_volume_mm3() / 1000;
    const Mask refitted = segment(set, mask.grid, {.drawn_on = mask.grid}).mask;
    const auto count = [](const Mask& one) { return static_cast<double>(std::ranges::count(one.values, 1)); };
    double both = 0;
    for (std::size_t n = 0; n < mask.values.size(); ++n) both += mask.values[n] == 1 && refitted.values[n] == 1;
    const double own = count(mask), again = count(refitted);
    return {set.name, own * voxel_ml, again * voxel_ml, 2 * both / (own + again)};
}

/// Adds the mask itself.
void add_to_correct(ImportContent& imported, const Mask& mask, MaskOrigin of) {
    if (std::ranges::find(mask.values, 1) == mask.values.end()) {
        imported.notes.push_back(fmt::format("{} is empty", of.name.empty() ? "The mask" : of.name));
        return;
    }
    ContourSet set;
    set.name = std::move(of.name);
    set.attributes = std::move(of.attributes);
    if (of.label_value) imported.label_values[imported.sets.size()] = *of.label_value;
    imported.masks[imported.sets.size()] = {std::make_shared<const StoredMask>(mask), std::move(of.source)};
    imported.sets.push_back(std::move(set));
}

/// Adds what a mask becomes, or why it becomes nothing.
void add_traced(ImportContent& imported, const Mask& mask, MaskOrigin of, const Upload& request) {
    if (request.purpose == Upload::Purpose::correct && !request.trace.preview)
        return add_to_correct(imported, mask, std::move(of));
    ContourSet set = traced(mask, request);
    if (set.contours.empty()) {
        imported.notes.push_back(fmt::format("{} is too small to be traced", of.name.empty() ? "The mask" : of.name));
        return;
    }
    set.name = std::move(of.name);
    set.attributes = std::move(of.attributes);
    if (request.trace.preview) return imported.traced.push_back(preview_of(mask, set));
    if (of.label_value) imported.label_values[imported.sets.size()] = *of.label_value;
    imported.sets.push_back(std::move(set));
}

/// Every segment of a DICOM segmentation, they may overlap.
ImportContent read_segments_of(const fs::path& path, const Upload& request) {
    const auto [about, masks] = read_dicom_segments(path);
    if (about.segments.size() > kMostImportedLabels)
        throw Error(ErrorKind::too_large, fmt::format("the segmentation has {} segments; the limit is {}",
                                                      about.segments.size(), kMostImportedLabels));
    ImportContent imported{{}, about.notes, about.frame_of_reference_uid, {}};
    for (std::size_t n = 0; n < masks.size(); ++n) {
        const DicomSegment& segment = about.segments[n];
        const std::string name = segment.label.empty() ? fmt::format("Segment {}", segment.number) : segment.label;
        add_traced(imported, masks[n], {name, attributes_of(segment), {}, segment.algorithm_name}, request);
    }
    if (imported.sets.empty() && imported.traced.empty())
        throw Error(ErrorKind::invalid_input, "the segmentation has nothing that is large enough to trace");
    return imported;
}

ImportContent read_contours_of(const fs::path& path, const Upload& request) {
    if (path.extension() == ".dcm" && is_rtstruct(path)) return read_rtstruct_of(path, request);
    if (path.extension() == ".dcm" && is_dicom_seg(path)) return read_segments_of(path, request);
    ReadContours read = read_contours(path);
    for (std::string& note : check_and_tidy_moments(read.contours)) read.notes.push_back(std::move(note));
    return {{std::move(read.contours)}, std::move(read.notes), std::move(read.frame_of_reference_uid), {}};
}

/// What 3D Slicer's segmentations say of the labels of each of their layers, and NIfTI's table of the one layer there is.
std::map<std::int64_t, std::map<std::int64_t, MaskOrigin>> named_layers(const fs::path& path) {
    std::map<std::int64_t, std::map<std::int64_t, MaskOrigin>> layers;
    if (path.extension() == ".nii" || path.extension() == ".gz")
        for (const LabelName& label : read_nifti_labels(path))
            layers[0][label.label] = {label.name, StructureAttributes{.color = to_rgb8(label.color)}};
    if (path.extension() == ".nrrd")
        for (const NrrdSegment& segment : read_nrrd_segments(path)) {
            const SegmentTerms terms = terms_in_tags(segment.tags);
            layers[segment.layer][segment.label_value] = {
                segment.name,
                StructureAttributes{.color = to_rgb8(segment.color), .category = terms.category, .code = terms.code}};
        }
    if (layers.empty()) layers[0];
    return layers;
}

/// Adds each label; false where there is none.
bool add_labels(ImportContent& imported, const Image& labels, const std::map<std::int64_t, MaskOrigin>& named,
                const Upload& request) {
    const auto counts = count_labels(labels, kMostImportedLabels);
    for (const auto& [label, voxels] : counts) {
        const auto known = named.find(label);
        const bool is_alone = counts.size() == 1;
        MaskOrigin of = known == named.end() ? MaskOrigin{is_alone ? "" : fmt::format("Label {}", label)} : known->second;
        if (label > 0 && label <= kLargestLabelValue && !(is_alone && label == 1)) of.label_value = label;  // 1: any mask's
        add_traced(imported, select_label(labels, static_cast<double>(label)), std::move(of), request);
    }
    return !counts.empty();
}

ImportContent read_mask_of(const fs::path& path, const Upload& request) {
    ImportContent imported;
    bool has_labels = false;
    const auto layers = named_layers(path);
    for (const auto& [layer, named] : layers) {
        ReadImageOptions options;
        if (layers.size() > 1) options.frame = layer + 1;
        has_labels |= add_labels(imported, read_label_image(path, options), named, request);
    }
    if (!has_labels) throw Error(ErrorKind::invalid_input, "the mask is empty");
    if (imported.sets.empty() && imported.traced.empty())
        throw Error(ErrorKind::invalid_input, "the mask has nothing that is large enough to trace");
    return imported;
}

}  // namespace

ImportContent read_import(const fs::path& path, const Upload& upload) {
    ImportContent imported =
        upload.content == Upload::Content::mask ? read_mask_of(path, upload) : read_contours_of(path, upload);
    if (path.extension() == ".dcm") imported.patient = patient_words(dicom_identity(path));
    return imported;
}

}  // namespace kontur::viewer
