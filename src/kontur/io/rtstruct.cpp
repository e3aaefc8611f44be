// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/rtstruct.h"

#include <fmt/format.h>

#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/io/dcmtk.h"
#include "kontur/io/decimal_string.h"
#include "kontur/io/dicom_header.h"
#include "kontur/io/roi_contours.h"

namespace kontur {
namespace {

Error corrupt(const std::string& message) { return Error(ErrorKind::corrupt_file, message); }

/// The text of ContourData. Explicit-VR files store more than 65534 bytes as VR UN, which DCMTK keeps as plain bytes.
std::string_view contour_data(DcmItem& item) {
    DcmElement* element = nullptr;
    if (item.findAndGetElement(DCM_ContourData, element).bad() || element->getLength() == 0) return {};
    if (char* text = nullptr; element->ident() != EVR_UN) {
        Uint32 length = 0;
        auto* string = dynamic_cast<DcmByteString*>(element);
        if (string && string->getString(text, length).good() && text) return {text, length};
    } else if (Uint8* bytes = nullptr; element->getUint8Array(bytes).good() && bytes) {
        return {reinterpret_cast<const char*>(bytes), element->getLength()};
    }
    throw corrupt("its ContourData cannot be read");
}

StoredContour read_contour(DcmItem& item) {
    StoredContour contour;
    contour.type = dcmtk::text(item, DCM_ContourGeometricType);
    const std::vector<double> values = parse_decimal_string(contour_data(item));
    if (values.size() % 3 != 0)
        throw corrupt(fmt::format("it has {} coordinates, which is no multiple of 3", values.size()));
    const std::int64_t points = static_cast<std::int64_t>(values.size() / 3);
    const std::int64_t declared = dcmtk::integer(item, DCM_NumberOfContourPoints).value_or(points);
    if (points != declared) throw corrupt(fmt::format("it declares {} points and has {}", declared, points));
    contour.points.reserve(values.size() / 3);
    for (std::size_t n = 0; n < values.size(); n += 3) contour.points.push_back({values[n], values[n + 1], values[n + 2]});
    return contour;
}

std::vector<StoredContour> read_contours(DcmItem& roi_contour) {
    std::vector<StoredContour> contours;
    for (DcmItem* item : dcmtk::items(roi_contour, DCM_ContourSequence)) {
        try {
            contours.push_back(read_contour(*item));
        } catch (const Error& error) {
            throw error.with_context(fmt::format("contour {}", contours.size() + 1));
        }
    }
    return contours;
}

std::optional<std::array<std::uint8_t, 3>> read_color(DcmItem& roi_contour) {
    const std::vector<double> values = dcmtk::decimals(roi_contour, DCM_ROIDisplayColor);
    const auto is_level = [](double v) { return v >= 0 && v <= 255; };
    if (values.size() != 3 || !std::all_of(values.begin(), values.end(), is_level)) return std::nullopt;
    const auto level = [&](std::size_t n) { return static_cast<std::uint8_t>(values[n]); };
    return std::array{level(0), level(1), level(2)};
}

std::int64_t required_number(DcmItem& item, const DcmTagKey& tag) {
    const std::optional<std::int64_t> number = dcmtk::integer(item, tag);
    if (!number) throw corrupt(dcmtk::tag_name(tag) + " is missing");
    return *number;
}

std::vector<Roi> read_roi_list(DcmItem& dataset) {
    std::vector<Roi> rois;
    for (DcmItem* item : dcmtk::items(dataset, DCM_StructureSetROISequence)) {
        Roi roi;
        roi.number = required_number(*item, DCM_ROINumber);
        roi.name = roi.contours.name = dcmtk::text(*item, DCM_ROIName);
        roi.frame_of_reference_uid = dcmtk::text(*item, DCM_ReferencedFrameOfReferenceUID);
        roi.generation_algorithm = dcmtk::text(*item, DCM_ROIGenerationAlgorithm);
        if (std::any_of(rois.begin(), rois.end(), [&](const Roi& other) { return other.number == roi.number; }))
            throw corrupt(fmt::format("two ROIs have the number {}", roi.number));
        rois.push_back(std::move(roi));
    }
    return rois;
}

/// The ROI that an item of another sequence is about.
Roi& referenced_roi(std::vector<Roi>& rois, DcmItem& item) {
    const std::int64_t number = required_number(item, DCM_ReferencedROINumber);
    const auto found = std::find_if(rois.begin(), rois.end(), [&](const Roi& roi) { return roi.number == number; });
    if (found == rois.end()) throw corrupt(fmt::format("contours refer to ROI {}, which is not listed", number));
    return *found;
}

void read_roi_contours(Roi& roi, DcmItem& roi_contour) {
    try {
        roi.color = read_color(roi_contour);
        InterpretedContours interpreted = interpret_contours(read_contours(roi_contour));
        roi.contours.contours = std::move(interpreted.contours);
        roi.contours.surface = std::move(interpreted.surface);
        roi.notes = std::move(interpreted.notes);
        if (const std::size_t dropped = drop_duplicate_points(roi.contours); dropped > 0)
            roi.notes.push_back(
                fmt::format("left out {} repetition{} of a neighbouring point", dropped, dropped == 1 ? "" : "s"));
    } catch (const Error& error) {
        throw error.with_context(fmt::format("ROI {} '{}'", roi.number, roi.name));
    }
}

StructureSet read_structure_set(DcmItem& dataset) {
    const std::string modality = dcmtk::text(dataset, DCM_Modality);
    if (modality != "RTSTRUCT")
        throw Error(ErrorKind::invalid_input, fmt::format("is no RT structure set but DICOM of modality '{}'", modality));
    if (!dataset.tagExists(DCM_StructureSetROISequence) || !dataset.tagExists(DCM_ROIContourSequence))
        throw corrupt("has no list of ROIs or none of contours");
    StructureSet set;
    set.label = dcmtk::text(dataset, DCM_StructureSetLabel);
    set.rois = read_roi_list(dataset);
    for (DcmItem* item : dcmtk::items(dataset, DCM_ROIContourSequence))
        read_roi_contours(referenced_roi(set.rois, *item), *item);
    for (DcmItem* item : dcmtk::items(dataset, DCM_RTROIObservationsSequence))
        referenced_roi(set.rois, *item).interpreted_type = dcmtk::text(*item, DCM_RTROIInterpretedType);
    return set;
}

std::string listed(const std::vector<Roi>& rois) {
    if (rois.empty()) return "none";
    std::string text;
    for (const Roi& roi : rois)
        text += fmt::format("{}{} '{}' ({} contours)", text.empty() ? "" : ", ", roi.number, roi.name,
                            roi.contours.contours.size());
    return text;
}

template <typename Condition>
std::vector<const Roi*> rois_where(const std::vector<Roi>& rois, const Condition& condition) {
    std::vector<const Roi*> found;
    for (const Roi& roi : rois)
        if (condition(roi)) found.push_back(&roi);
    return found;
}

}  // namespace

bool is_rtstruct(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored) || !has_dicom_prefix(path)) return false;
    DcmFileFormat file;
    dcmtk::load(file, path, DCM_Manufacturer);  // the element after Modality
    return dcmtk::text(*file.getDataset(), DCM_Modality) == "RTSTRUCT";
}

StructureSet read_rtstruct(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored) && !has_dicom_prefix(path))
        throw Error(ErrorKind::invalid_input, path.string() + ": is no DICOM file");
    DcmFileFormat file;
    dcmtk::load(file, path);
    try {
        return read_structure_set(*file.getDataset());
    } catch (const Error& error) {
        throw error.with_context(path.string());
    }
}

Roi select_roi(const StructureSet& set, const std::optional<std::string>& name_or_number) {
    const auto refuse = [&](const std::string& why) {
        throw Error(ErrorKind::invalid_input, fmt::format("{}; the ROIs are: {}", why, listed(set.rois)));
    };
    std::vector<const Roi*> found;
    if (!name_or_number) {
        found = rois_where(set.rois, [](const Roi& roi) { return !roi.contours.contours.empty(); });
        if (found.size() != 1) refuse(found.empty() ? "no ROI has contours" : "several ROIs have contours; name one");
        return *found.front();
    }
    found = rois_where(set.rois, [&](const Roi& roi) { return roi.name == *name_or_number; });
    if (found.empty())
        found = rois_where(set.rois, [&](const Roi& roi) { return std::to_string(roi.number) == *name_or_number; });
    if (found.empty()) refuse(fmt::format("there is no ROI '{}'", *name_or_number));
    if (found.size() > 1) refuse(fmt::format("{} ROIs have the name '{}'; give a number", found.size(), *name_or_number));
    return *found.front();
}

}  // namespace kontur
