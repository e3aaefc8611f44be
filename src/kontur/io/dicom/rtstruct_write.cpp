// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/dicom/decimal_string.h"
#include "kontur/io/dicom/dicom_document.h"
#include "kontur/io/dicom/dicom_names.h"
#include "kontur/io/dicom/roi_attributes.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/dicom/rtstruct_approval.h"
#include "kontur/io/geometry/keyhole.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

using dcmtk::append_item;
using dcmtk::put;
using dcmtk::put_image_reference;

constexpr std::size_t kMostLabel = 16;  ///< characters, of VR SH
constexpr double kTouchingMm = 1e-6;    ///< what rounding leaves of the distance between touching contours

Error invalid(const std::string& message) { return Error(ErrorKind::invalid_input, message); }

/// A contour as it will stand in the file.
struct StoredPath {
    std::vector<Vec3> points;
    const char* type = "CLOSED_PLANAR";
    const Plane* plane = nullptr;
};

void check_contour(const Contour& contour) {
    if (!contour.closed) throw invalid("it is open; only closed contours can be written");
    if (contour.points.size() < 3)
        throw invalid(fmt::format("it has {}; at least 3 are needed", counted(contour.points.size(), "point")));
    if (!std::all_of(contour.points.begin(), contour.points.end(), is_finite))
        throw invalid("it has a NaN or infinite coordinate");
}

void check_set(const ContourSet& set, const Nesting& nesting) {
    if (!set.interior.empty() || !set.exterior.empty() || !set.surface.empty())
        throw Error(ErrorKind::unsupported,
                    "points inside, outside or on the surface cannot be written to an RT structure set");
    for (std::size_t n = 0; n < set.contours.size(); ++n) {
        try {
            check_contour(set.contours[n]);
            if (set.contours[n].hole && nesting.depth[n] == 0) throw invalid("it is a hole that no contour encloses");
        } catch (const Error& error) {
            throw error.with_context(fmt::format("contour {}", n + 1));
        }
    }
}

/// Filled even-odd.
bool is_hole(const Nesting& nesting, std::size_t contour) { return nesting.depth[contour] % 2 == 1; }

/// The holes that lie directly in contour `outer`.
std::vector<std::vector<Vec3>> holes_in(const std::vector<Contour>& contours, const Nesting& nesting, std::size_t outer) {
    std::vector<std::vector<Vec3>> holes;
    for (std::size_t n = 0; n < contours.size(); ++n) {
        const auto& enclosing = nesting.enclosing[n];
        if (is_hole(nesting, n) && nesting.depth[n] == nesting.depth[outer] + 1 &&
            std::find(enclosing.begin(), enclosing.end(), outer) != enclosing.end())
            holes.push_back(contours[n].points);
    }
    return holes;
}

std::vector<StoredPath> keyholes(const std::vector<Contour>& contours, const Nesting& nesting) {
    std::vector<StoredPath> paths;
    for (std::size_t n = 0; n < contours.size(); ++n) {
        if (is_hole(nesting, n)) continue;
        StoredPath& path = paths.emplace_back();
        path.plane = &contours[n].plane;
        const auto holes = holes_in(contours, nesting, n);
        path.points = holes.empty() ? contours[n].points : join_keyhole(contours[n].points, holes, *path.plane);
    }
    return paths;
}

/// PS3.3 C.8.8.6.3: when one contour of a ROI is combined by exclusive or, all are.
std::vector<StoredPath> rings(const std::vector<Contour>& contours, const char* type) {
    std::vector<StoredPath> paths;
    paths.reserve(contours.size());
    for (const Contour& contour : contours) paths.push_back({contour.points, type, &contour.plane});
    return paths;
}

std::vector<StoredPath> stored_paths(const ContourSet& set, HoleEncoding encoding) {
    const Nesting nesting = find_nesting(set.contours, kTouchingMm);
    check_set(set, nesting);
    const bool has_holes =
        std::any_of(nesting.enclosing.begin(), nesting.enclosing.end(), [](const auto& e) { return !e.empty(); });
    if (has_holes && encoding == HoleEncoding::keyhole) return keyholes(set.contours, nesting);
    return rings(set.contours, has_holes && encoding == HoleEncoding::exclusive ? "CLOSEDPLANAR_XOR" : "CLOSED_PLANAR");
}

/// The slice on which a contour lies: parallel to it and nearer than a tenth of the way to the next slice. Contours are
/// often some hundredths of a millimetre off their slice.
const DicomHeader* slice_of(const StoredPath& path, const std::vector<DicomHeader>& slices) {
    const auto off = [&](const DicomHeader& slice) {
        return std::abs(dot(slice.placement.normal(), path.points.front() - slice.placement.position));
    };
    const auto nearer = [&](const DicomHeader& a, const DicomHeader& b) { return off(a) < off(b); };
    const DicomHeader& nearest = *std::min_element(slices.begin(), slices.end(), nearer);
    const Vec3 normal = nearest.placement.normal();
    const double step = slices.size() > 1
                            ? std::abs(dot(normal, slices[1].placement.position - slices[0].placement.position))
                            : nearest.thickness_mm.value_or(1);
    const bool on_slice = off(nearest) <= 0.1 * step && std::abs(dot(normal, path.plane->normal)) > 1 - 1e-6;
    return on_slice ? &nearest : nullptr;
}

std::string contour_data(const std::vector<Vec3>& points) {
    std::string text;
    for (const Vec3& p : points)
        for (const double coordinate : {p.x, p.y, p.z}) {
            if (!text.empty()) text += '\\';
            text += to_decimal_string(coordinate);
        }
    return text;
}

void put_image_hierarchy(DcmItem& document, const std::vector<DicomHeader>& slices) {
    const char* const kDetachedStudyManagement = "1.2.840.10008.3.1.2.3.1";
    DcmItem& frame = append_item(document, DCM_ReferencedFrameOfReferenceSequence);
    put(frame, DCM_FrameOfReferenceUID, dcmtk::text(document, DCM_FrameOfReferenceUID));
    DcmItem& study = append_item(frame, DCM_RTReferencedStudySequence);
    put(study, DCM_ReferencedSOPClassUID, kDetachedStudyManagement);
    put(study, DCM_ReferencedSOPInstanceUID, dcmtk::text(document, DCM_StudyInstanceUID));
    DcmItem& series = append_item(study, DCM_RTReferencedSeriesSequence);
    put(series, DCM_SeriesInstanceUID, slices.front().series_uid);
    std::set<std::string> named;
    for (const DicomHeader& slice : slices)
        if (named.insert(slice.sop_instance_uid).second)
            dcmtk::put_file_reference(append_item(series, DCM_ContourImageSequence), slice);
}

class RoiWriter {
public:
    RoiWriter(DcmItem& document, const std::vector<DicomHeader>& slices, HoleEncoding holes)
        : document_(document), slices_(slices), holes_(holes) {}

    void write(const Roi& roi, const std::string& name, std::int64_t number, std::vector<std::string>& notes) {
        if (!roi.damage.empty()) throw invalid("its contours could not be read: " + roi.damage);
        const StructureAttributes attributes = storable(roi.contours.attributes, name, notes);
        put_listed(attributes, name, number);
        DcmItem& item = append_item(document_, DCM_ROIContourSequence);
        put(item, DCM_ReferencedROINumber, number);
        put_roi_contour(item, attributes);
        std::int64_t contour_number = 0;
        for (const StoredPath& path : stored_paths(roi.contours, holes_)) put_contour(item, path, ++contour_number);
        put_observed(attributes, number);
    }

    /// Contours without a slice so far.
    std::size_t off_slices() const { return off_slices_; }

private:
    void put_listed(const StructureAttributes& attributes, const std::string& name, std::int64_t number) {
        DcmItem& entry = append_item(document_, DCM_StructureSetROISequence);
        put(entry, DCM_ROINumber, number);
        put(entry, DCM_ReferencedFrameOfReferenceUID, dcmtk::text(document_, DCM_FrameOfReferenceUID));
        put(entry, DCM_ROIName, name);
        put_entry(entry, attributes);
    }

    void put_contour(DcmItem& roi, const StoredPath& path, std::int64_t number) {
        DcmItem& item = append_item(roi, DCM_ContourSequence);
        put(item, DCM_ContourNumber, number);
        if (const DicomHeader* slice = slice_of(path, slices_))
            put_image_reference(append_item(item, DCM_ContourImageSequence), *slice);
        else ++off_slices_;
        put(item, DCM_ContourGeometricType, path.type);
        put(item, DCM_NumberOfContourPoints, static_cast<std::int64_t>(path.points.size()));
        put(item, DCM_ContourData, contour_data(path.points));
    }

    void put_observed(const StructureAttributes& attributes, std::int64_t number) {
        DcmItem& item = append_item(document_, DCM_RTROIObservationsSequence);
        put(item, DCM_ObservationNumber, number);
        put(item, DCM_ReferencedROINumber, number);
        put_observation(item, attributes);
    }

    DcmItem& document_;
    const std::vector<DicomHeader>& slices_;
    HoleEncoding holes_;
    std::size_t off_slices_ = 0;
};

/// Of VR IS.
void check_number(std::int64_t number) {
    constexpr std::int64_t kLeast = std::numeric_limits<std::int32_t>::min(),
                           kMost = std::numeric_limits<std::int32_t>::max();
    if (number < kLeast || number > kMost)
        throw invalid(fmt::format("a ROI has the number {}; {} to {} are possible", number, kLeast, kMost));
}

/// The ROIs' own numbers, else those of their attributes, else the lowest free ones.
std::vector<std::int64_t> roi_numbers(const std::vector<Roi>& rois) {
    std::vector<std::int64_t> numbers(rois.size());
    std::set<std::int64_t> taken;
    const auto take = [&](std::size_t n, std::int64_t number) {
        if (number == 0 || !taken.insert(number).second) return false;
        check_number(numbers[n] = number);
        return true;
    };
    for (std::size_t n = 0; n < rois.size(); ++n)
        if (rois[n].number != 0 && !take(n, rois[n].number))
            throw invalid(fmt::format("two ROIs have the number {}", rois[n].number));
    for (std::size_t n = 0; n < rois.size(); ++n)
        if (numbers[n] == 0) take(n, rois[n].contours.attributes.number.value_or(0));
    for (std::size_t n = 0; n < rois.size(); ++n)
        for (std::int64_t number = 1; numbers[n] == 0; ++number) take(n, number);
    return numbers;
}

std::vector<std::string> names_of(const std::vector<Roi>& rois) {
    std::vector<std::string> names;
    const auto is_blank = [](const std::string& name) { return name.find_first_not_of(' ') == std::string::npos; };
    for (const Roi& roi : rois) {
        const std::string& name = is_blank(roi.name) ? roi.contours.name : roi.name;
        names.push_back(is_blank(name) ? fmt::format("Structure_{}", names.size() + 1) : name);
    }
    return names;
}

}  // namespace

std::vector<std::string> write_rtstruct(const std::filesystem::path& path, const StructureSet& set,
                                        const DicomSeries& images, const WriteRtstructOptions& options) {
    dcmtk::set_up();
    const std::vector<DicomHeader> slices = read_slice_headers(images);
    const std::vector<std::int64_t> numbers = roi_numbers(set.rois);
    check_utf8(set.label, "the structure set's label");
    std::vector<std::string> notes;
    const std::vector<std::string> names = dcmtk::stored_names(names_of(set.rois), "ROI", notes);
    DcmFileFormat file;
    DcmItem& document = *file.getDataset();
    const std::string description =
        dcmtk::description_with_names(options.series_description, WriteRtstructOptions{}.series_description, names);
    dcmtk::start_document(document, images, {UID_RTStructureSetStorage, "RTSTRUCT", description, options.series_number});
    put(document, DCM_StructureSetLabel,
        dcmtk::noted_value(set.label.empty() ? "kontur" : set.label, kMostLabel, "the structure set's label", notes));
    put(document, DCM_StructureSetDate, dcmtk::text(document, DCM_InstanceCreationDate));
    put(document, DCM_StructureSetTime, dcmtk::text(document, DCM_InstanceCreationTime));
    put_approval(document, set.rois, notes);
    dcmtk::put_contribution(document, options.provenance);
    put_image_hierarchy(document, slices);
    RoiWriter writer(document, slices, options.holes);
    for (std::size_t n = 0; n < set.rois.size(); ++n) {
        try {
            writer.write(set.rois[n], names[n], numbers[n], notes);
        } catch (const Error& error) {
            throw error.with_context(fmt::format("ROI {} '{}'", numbers[n], set.rois[n].name));
        }
    }
    // Explicit VR has 16-bit lengths for decimal strings; a contour of 1300 points would not fit.
    dcmtk::save(file, path, EXS_LittleEndianImplicit);
    if (images.frame_of_reference_uid.empty())
        notes.emplace_back("the images name no common frame of reference; the structure set names a new one");
    if (writer.off_slices() > 0)
        notes.push_back(
            fmt::format("{} contour{} on no slice of the images, and carry no reference to one; many programs ignore such",
                        writer.off_slices(), writer.off_slices() == 1 ? " lies" : "s lie"));
    return notes;
}

}  // namespace kontur
