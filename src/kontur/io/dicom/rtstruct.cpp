// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/rtstruct.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/dicom/dcmtk.h"
#include "kontur/io/dicom/decimal_string.h"
#include "kontur/io/dicom/dicom_document.h"
#include "kontur/io/dicom/dicom_start.h"
#include "kontur/io/dicom/roi_attributes.h"
#include "kontur/io/dicom/roi_contours.h"
#include "kontur/io/dicom/rtstruct_approval.h"
#include "kontur/io/dicom/rtstruct_in_time.h"

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

/// Which volume in time a slice belongs to: by its file's UID and its frame in there.
class FrameOfSlice {
public:
    explicit FrameOfSlice(const std::vector<DicomSeries>& frames) {
        for (std::size_t n = 0; n < frames.size(); ++n)
            for (const DicomHeader& slice : read_slice_headers(frames[n]))
                frames_.emplace(std::pair(slice.sop_instance_uid, slice.frame.value_or(1)), n);
    }

    /// nullopt: it refers to no slice, or to slices of several volumes.
    std::optional<std::size_t> of(DcmItem& contour) const {
        std::set<std::optional<std::size_t>> found;
        for (DcmItem* image : dcmtk::items(contour, DCM_ContourImageSequence)) {
            const auto in_file = dcmtk::integer(*image, DCM_ReferencedFrameNumber).value_or(1);
            const auto frame = frames_.find({dcmtk::text(*image, DCM_ReferencedSOPInstanceUID), in_file});
            found.insert(frame == frames_.end() ? std::nullopt : std::optional(frame->second));
        }
        return found.size() == 1 ? *found.begin() : std::nullopt;
    }

private:
    std::map<std::pair<std::string, std::int64_t>, std::size_t> frames_;
};

StoredContour read_contour(DcmItem& item, const FrameOfSlice& frames) {
    StoredContour contour;
    contour.frame = frames.of(item);
    contour.type = dcmtk::text(item, DCM_ContourGeometricType);
    const std::vector<double> values = parse_decimal_string(contour_data(item));
    if (values.size() % 3 != 0)
        throw corrupt(fmt::format("it has {} coordinates, which is no multiple of 3", values.size()));
    const std::int64_t points = static_cast<std::int64_t>(values.size() / 3);
    const std::int64_t declared = dcmtk::integer(item, DCM_NumberOfContourPoints).value_or(points);
    if (points != declared) throw corrupt(fmt::format("it declares {} points and has {}", declared, points));
    const std::vector<double> offset = dcmtk::decimals(item, DCM_RETIRED_ContourOffsetVector);
    if (std::any_of(offset.begin(), offset.end(), [](double mm) { return mm != 0; }))
        throw corrupt("its ContourOffsetVector is not 0; contours that are shifted by one are not read");
    contour.points.reserve(values.size() / 3);
    for (std::size_t n = 0; n < values.size(); n += 3) contour.points.push_back({values[n], values[n + 1], values[n + 2]});
    return contour;
}

void append_contours(DcmItem& roi_contour, const FrameOfSlice& frames, std::vector<StoredContour>& contours) {
    for (DcmItem* item : dcmtk::items(roi_contour, DCM_ContourSequence)) {
        try {
            contours.push_back(read_contour(*item, frames));
        } catch (const Error& error) {
            throw error.with_context(fmt::format("contour {}", contours.size() + 1));
        }
    }
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
        roi.contours.attributes.number = roi.number;
        read_entry(*item, roi.contours.attributes);
        if (std::any_of(rois.begin(), rois.end(), [&](const Roi& other) { return other.number == roi.number; }))
            throw corrupt(fmt::format("two ROIs have the number {}", roi.number));
        rois.push_back(std::move(roi));
    }
    return rois;
}

Roi* find_roi(std::vector<Roi>& rois, std::int64_t number) {
    const auto found = std::find_if(rois.begin(), rois.end(), [&](const Roi& roi) { return roi.number == number; });
    return found == rois.end() ? nullptr : &*found;
}

/// Each frame's by themselves: a ring is no hole of another frame's.
InterpretedContours interpret_in_time(const std::vector<StoredContour>& stored) {
    std::map<std::optional<std::size_t>, std::vector<StoredContour>> of_frames;
    for (const StoredContour& contour : stored) of_frames[contour.frame].push_back(contour);
    if (of_frames.empty() || of_frames.contains(std::nullopt)) {
        InterpretedContours all = interpret_contours(stored);
        if (of_frames.size() > 1)
            all.notes.push_back(fmt::format("{} of {} refer to slices of no frame or of several, so all are of no frame",
                                            of_frames.at(std::nullopt).size(), counted(stored.size(), "contour")));
        return all;
    }
    InterpretedContours all;
    for (const auto& [frame, contours] : of_frames) {
        InterpretedContours one = interpret_contours(contours);
        for (Contour& contour : one.contours) {
            contour.frame = static_cast<double>(*frame + 1);
            all.contours.push_back(std::move(contour));
        }
        std::move(one.surface.begin(), one.surface.end(), std::back_inserter(all.surface));
        for (const std::string& note : one.notes) all.notes.push_back(fmt::format("frame {}: {}", *frame + 1, note));
    }
    return all;
}

/// The items that hold the contours of one ROI: one, but some programs write several.
void read_roi_contours(Roi& roi, const std::vector<DcmItem*>& items, const FrameOfSlice& frames) {
    std::vector<StoredContour> stored;
    for (DcmItem* item : items) {
        read_roi_contour(*item, roi.contours.attributes);
        append_contours(*item, frames, stored);
    }
    InterpretedContours interpreted = interpret_in_time(stored);
    roi.contours.contours = std::move(interpreted.contours);
    roi.contours.surface = std::move(interpreted.surface);
    roi.notes = std::move(interpreted.notes);
    if (items.size() > 1)
        roi.notes.push_back(fmt::format("its contours stand in {} items of the file, which are joined", items.size()));
    if (const std::size_t dropped = drop_duplicate_points(roi.contours); dropped > 0)
        roi.notes.push_back(fmt::format("left out {} of a neighbouring point", counted(dropped, "repetition")));
}

/// Damage in one ROI says nothing about the others.
void read_roi_contours_or_damage(Roi& roi, const std::vector<DcmItem*>& items, const FrameOfSlice& frames) {
    try {
        read_roi_contours(roi, items, frames);
    } catch (const Error& error) {
        roi.damage = error.with_context(fmt::format("ROI {} '{}'", roi.number, roi.name)).what();
    }
}

/// Adds nothing without numbers.
void note_unlisted(StructureSet& set, std::string_view what, const std::set<std::int64_t>& numbers) {
    if (numbers.empty()) return;
    set.notes.push_back(
        numbers.size() == 1
            ? fmt::format("left out {} of ROI {}, which is not listed", what, *numbers.begin())
            : fmt::format("left out {} of {} ROIs that are not listed: {}", what, numbers.size(), fmt::join(numbers, ", ")));
}

void read_all_contours(StructureSet& set, DcmItem& dataset, const FrameOfSlice& frames) {
    std::map<std::int64_t, std::vector<DcmItem*>> items;
    std::set<std::int64_t> unlisted;
    for (DcmItem* item : dcmtk::items(dataset, DCM_ROIContourSequence)) {
        const std::int64_t number = required_number(*item, DCM_ReferencedROINumber);
        if (find_roi(set.rois, number)) items[number].push_back(item);
        else unlisted.insert(number);
    }
    note_unlisted(set, "contours", unlisted);
    for (const auto& [number, its_items] : items)
        read_roi_contours_or_damage(*find_roi(set.rois, number), its_items, frames);
}

void read_observations(StructureSet& set, DcmItem& dataset) {
    std::set<std::int64_t> unlisted;
    for (DcmItem* item : dcmtk::items(dataset, DCM_RTROIObservationsSequence)) {
        const std::int64_t number = required_number(*item, DCM_ReferencedROINumber);
        if (Roi* roi = find_roi(set.rois, number)) read_observation(*item, roi->contours.attributes, roi->notes);
        else unlisted.insert(number);
    }
    note_unlisted(set, "observations", unlisted);
}

StructureSet read_structure_set(DcmItem& dataset, const FrameOfSlice& frames) {
    const std::string modality = dcmtk::text(dataset, DCM_Modality);
    if (modality != "RTSTRUCT")
        throw Error(ErrorKind::invalid_input, fmt::format("is no RT structure set but DICOM of modality '{}'", modality));
    if (!dataset.tagExists(DCM_StructureSetROISequence) || !dataset.tagExists(DCM_ROIContourSequence))
        throw corrupt("has no list of ROIs or none of contours");
    StructureSet set;
    set.label = dcmtk::text(dataset, DCM_StructureSetLabel);
    set.rois = read_roi_list(dataset);
    read_all_contours(set, dataset, frames);
    read_observations(set, dataset);
    read_approval(dataset, set);
    return set;
}

std::string listed(const std::vector<Roi>& rois) {
    if (rois.empty()) return "none";
    std::string text;
    for (const Roi& roi : rois)
        text += fmt::format("{}{} '{}' ({})", text.empty() ? "" : ", ", roi.number, roi.name,
                            roi.damage.empty() ? counted(roi.contours.contours.size(), "contour") : "damaged");
    return text;
}

template <typename Condition>
std::vector<const Roi*> rois_where(const std::vector<Roi>& rois, const Condition& condition) {
    std::vector<const Roi*> found;
    for (const Roi& roi : rois)
        if (condition(roi)) found.push_back(&roi);
    return found;
}

Roi readable(const Roi& roi) {
    if (!roi.damage.empty()) throw corrupt(roi.damage);
    return roi;
}

}  // namespace

bool is_rtstruct(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored) || !has_dicom_prefix(path)) return false;
    DcmFileFormat file;
    dcmtk::load(file, path, DCM_Manufacturer);  // the element after Modality
    return dcmtk::text(*file.getDataset(), DCM_Modality) == "RTSTRUCT";
}

StructureSet read_rtstruct(const std::filesystem::path& path) { return read_rtstruct_in_time(path, {}); }

StructureSet read_rtstruct_in_time(const std::filesystem::path& path, const std::vector<DicomSeries>& frames) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored) && !has_dicom_prefix(path))
        throw Error(ErrorKind::invalid_input, path.string() + ": is no DICOM file");
    DcmFileFormat file;
    dcmtk::load(file, path);
    try {
        return read_structure_set(*file.getDataset(), FrameOfSlice(frames));
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
        found = rois_where(set.rois, [](const Roi& roi) { return !roi.contours.contours.empty() || !roi.damage.empty(); });
        if (found.size() != 1)
            refuse(found.empty() ? "no ROI has contours" : "several ROIs have contours; choose one with the option roi");
        return readable(*found.front());
    }
    found = rois_where(set.rois, [&](const Roi& roi) { return roi.name == *name_or_number; });
    if (found.empty()) {
        const std::string small = without_case(*name_or_number);
        found = rois_where(set.rois, [&](const Roi& roi) { return without_case(roi.name) == small; });
        if (found.size() > 1)
            refuse(fmt::format("the names of {} ROIs are '{}' but for case; give one as it is written", found.size(),
                               *name_or_number));
    }
    if (found.empty())
        found = rois_where(set.rois, [&](const Roi& roi) { return std::to_string(roi.number) == *name_or_number; });
    if (found.empty()) refuse(fmt::format("there is no ROI '{}'", *name_or_number));
    if (found.size() > 1) refuse(fmt::format("{} ROIs have the name '{}'; give a number", found.size(), *name_or_number));
    return readable(*found.front());
}

}  // namespace kontur
