// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom_frames.h"

#include <fmt/format.h>

#include <cmath>

#include "kontur/base/error.h"

namespace kontur::dcmtk {
namespace {

/// Directions are written with about six digits; a worse deviation means that they are not what they claim to be.
constexpr double kDirectionTolerance = 1e-3;

Error corrupt(const std::string& message) { return Error(ErrorKind::corrupt_file, message); }

std::vector<double> decimals_of_count(DcmItem& item, const DcmTagKey& tag, std::size_t count) {
    std::vector<double> values = decimals(item, tag);
    if (values.size() != count)
        throw corrupt(fmt::format("{} has {} values instead of {}", tag_name(tag), values.size(), count));
    return values;
}

DcmItem* first_item(DcmItem* item, const DcmTagKey& sequence) {
    if (!item) return nullptr;
    const std::vector<DcmItem*> found = items(*item, sequence);
    return found.empty() ? nullptr : found.front();
}

}  // namespace

DcmItem* Frame::group(const DcmTagKey& sequence) const {
    DcmItem* own = first_item(own_, sequence);
    return own ? own : first_item(shared_, sequence);
}

DcmItem& Frame::required_group(const DcmTagKey& sequence) const {
    DcmItem* found = group(sequence);
    if (!found) throw corrupt(tag_name(sequence) + " is missing");
    return *found;
}

SlicePlacement Frame::placement() const {
    return read_placement(required_group(DCM_PlanePositionSequence), required_group(DCM_PlaneOrientationSequence),
                          required_group(DCM_PixelMeasuresSequence));
}

std::vector<Frame> frames_of(DcmItem& dataset) {
    const std::int64_t declared = integer(dataset, DCM_NumberOfFrames).value_or(1);
    const std::vector<DcmItem*> own = items(dataset, DCM_PerFrameFunctionalGroupsSequence);
    if (declared < 1 || declared != static_cast<std::int64_t>(own.size()))
        throw corrupt(fmt::format("it declares {} frames and describes {}", declared, own.size()));
    DcmItem* shared = first_item(&dataset, DCM_SharedFunctionalGroupsSequence);
    std::vector<Frame> frames;
    for (DcmItem* item : own) frames.emplace_back(item, shared);
    return frames;
}

SlicePlacement read_placement(DcmItem& position_item, DcmItem& orientation_item, DcmItem& measures) {
    const auto position = decimals_of_count(position_item, DCM_ImagePositionPatient, 3);
    const auto orientation = decimals_of_count(orientation_item, DCM_ImageOrientationPatient, 6);
    const auto spacing = decimals_of_count(measures, DCM_PixelSpacing, 2);
    const Vec3 row{orientation[0], orientation[1], orientation[2]}, column{orientation[3], orientation[4], orientation[5]};
    const auto is_unit = [](const Vec3& v) { return std::abs(norm(v) - 1) <= kDirectionTolerance; };
    if (!is_unit(row) || !is_unit(column) || std::abs(dot(row, column)) > kDirectionTolerance)
        throw corrupt("ImageOrientationPatient (0020,0037) is not a pair of perpendicular unit vectors");
    if (!(spacing[0] > 0) || !(spacing[1] > 0)) throw corrupt("PixelSpacing (0028,0030) is not positive");
    SlicePlacement placement;
    placement.position = {position[0], position[1], position[2]};
    placement.row_direction = normalized(row);
    placement.column_direction = normalized(column);
    // PixelSpacing gives the distance between rows (along j) first.
    placement.spacing_mm = {spacing[1], spacing[0]};
    return placement;
}

std::optional<double> first_decimal(DcmItem& item, const DcmTagKey& tag) {
    DcmElement* element = nullptr;
    if (Float64 value = 0;
        item.findAndGetElement(tag, element).good() && element->ident() == EVR_FD && element->getFloat64(value).good())
        return value;
    const std::vector<double> values = decimals(item, tag);
    return values.empty() ? std::nullopt : std::optional(values.front());
}

}  // namespace kontur::dcmtk
