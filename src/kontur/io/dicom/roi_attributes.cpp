// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/roi_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/dicom/decimal_string.h"
#include "kontur/io/dicom/dicom_code.h"
#include "kontur/io/dicom/dicom_document.h"
#include "kontur/io/dicom/dicom_names.h"

namespace kontur {
namespace {

const DcmTagKey kObservationDescription(0x3006, 0x0088);  // which DCMTK 3.6.9 names otherwise than 3.6.7

using dcmtk::append_item;
using dcmtk::put;
using dcmtk::text;

constexpr std::size_t kMostKeyword = 16;  ///< characters, of VR CS

std::optional<std::array<std::uint8_t, 3>> read_color(DcmItem& roi_contour) {
    const std::vector<double> values = dcmtk::decimals(roi_contour, DCM_ROIDisplayColor);
    const auto is_level = [](double v) { return v >= 0 && v <= 255; };
    if (values.size() != 3 || !std::all_of(values.begin(), values.end(), is_level)) return std::nullopt;
    const auto level = [&](std::size_t n) { return static_cast<std::uint8_t>(values[n]); };
    return std::array{level(0), level(1), level(2)};
}

/// Without the fractions of a mixture, for which there is no room.
void read_properties(DcmItem& observation, StructureAttributes& attributes, std::vector<std::string>& notes) {
    for (DcmItem* item : dcmtk::items(observation, DCM_ROIPhysicalPropertiesSequence)) {
        const std::string property = text(*item, DCM_ROIPhysicalProperty);
        const std::vector<double> value = dcmtk::decimals(*item, DCM_ROIPhysicalPropertyValue);
        if (property.empty() || value.size() != 1 || item->tagExists(DCM_ROIElementalCompositionSequence))
            notes.push_back(fmt::format("left out its physical property '{}', which is not one number", property));
        else attributes.physical_properties.push_back({property, value.front()});
    }
}

/// Some programs write small letters; DICOM has none there. What else it cannot hold is left out, with a note.
std::string keyword(const std::string& text, const std::string& subject, std::vector<std::string>& notes) {
    std::string word = text;
    std::transform(word.begin(), word.end(), word.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    const auto is_allowed = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == ' ' || c == '_'; };
    if (word.size() <= kMostKeyword && std::all_of(word.begin(), word.end(), is_allowed)) return word;
    notes.push_back(fmt::format("{} is '{}' and left out: DICOM has room for {} capitals, digits, blanks and underscores",
                                subject, shortened(printable_utf8(text), 100), kMostKeyword));
    return "";
}

}  // namespace

void read_entry(DcmItem& entry, StructureAttributes& attributes) {
    attributes.generation_algorithm = text(entry, DCM_ROIGenerationAlgorithm);
    attributes.description = dcmtk::lines(entry, DCM_ROIDescription);
}

void read_roi_contour(DcmItem& roi_contour, StructureAttributes& attributes) {
    if (const auto color = read_color(roi_contour)) attributes.color = color;
}

void read_observation(DcmItem& observation, StructureAttributes& attributes, std::vector<std::string>& notes) {
    if (const std::string type = text(observation, DCM_RTROIInterpretedType); !type.empty())
        attributes.interpreted_type = type;
    if (const auto code = dcmtk::read_code(observation, DCM_RTROIIdentificationCodeSequence)) attributes.code = code;
    attributes.review.comment = dcmtk::lines(observation, kObservationDescription);
    read_properties(observation, attributes, notes);
}

StructureAttributes storable(StructureAttributes attributes, const std::string& roi, std::vector<std::string>& notes) {
    const auto of_roi = [&](const char* what) { return fmt::format("the {} of ROI '{}'", what, roi); };
    attributes.interpreted_type = keyword(attributes.interpreted_type, of_roi("type"), notes);
    attributes.generation_algorithm = keyword(attributes.generation_algorithm, of_roi("generation algorithm"), notes);
    attributes.description =
        dcmtk::noted_text(attributes.description, dcmtk::kMostTextCharacters, of_roi("description"), notes);
    attributes.review.comment =
        dcmtk::noted_text(attributes.review.comment, dcmtk::kMostTextCharacters, of_roi("comment"), notes);
    if (attributes.code) attributes.code = dcmtk::storable(*attributes.code, of_roi("code"), notes);
    for (PhysicalProperty& one : attributes.physical_properties) {
        one.property = keyword(one.property, of_roi("physical property"), notes);
        if (!std::isfinite(one.value)) throw Error(ErrorKind::invalid_input, of_roi("physical property") + " is no number");
    }
    std::erase_if(attributes.physical_properties, [](const PhysicalProperty& one) { return one.property.empty(); });
    return attributes;
}

void put_entry(DcmItem& entry, const StructureAttributes& attributes) {
    if (!attributes.description.empty()) put(entry, DCM_ROIDescription, attributes.description);
    put(entry, DCM_ROIGenerationAlgorithm, attributes.generation_algorithm);
}

void put_roi_contour(DcmItem& roi_contour, const StructureAttributes& attributes) {
    if (!attributes.color) return;
    const auto& [red, green, blue] = *attributes.color;
    put(roi_contour, DCM_ROIDisplayColor, fmt::format("{}\\{}\\{}", red, green, blue));
}

void put_observation(DcmItem& observation, const StructureAttributes& attributes) {
    if (attributes.code) dcmtk::put_code(observation, DCM_RTROIIdentificationCodeSequence, *attributes.code);
    put(observation, DCM_RTROIInterpretedType, attributes.interpreted_type);
    put(observation, DCM_ROIInterpreter, "");
    if (!attributes.review.comment.empty()) put(observation, kObservationDescription, attributes.review.comment);
    for (const PhysicalProperty& one : attributes.physical_properties) {
        DcmItem& item = append_item(observation, DCM_ROIPhysicalPropertiesSequence);
        put(item, DCM_ROIPhysicalProperty, one.property);
        put(item, DCM_ROIPhysicalPropertyValue, to_decimal_string(one.value));
    }
}

}  // namespace kontur
