// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kontur {

/// A term of a coding scheme, such as {"10200004", "SCT", "Liver"} (DICOM PS3.3 section 8).
struct CodedConcept {
    std::string value;
    std::string scheme;
    std::string meaning;  ///< in words

    friend bool operator==(const CodedConcept&, const CodedConcept&) = default;
};

/// What dose calculation takes for a structure in place of what the CT shows (ROIPhysicalProperty).
struct PhysicalProperty {
    std::string property;  ///< "REL_ELEC_DENSITY", "REL_MASS_DENSITY", ...
    double value = 0;

    friend bool operator==(const PhysicalProperty&, const PhysicalProperty&) = default;
};

/// That somebody has looked at a structure as it is and takes it for right.
struct Approval {
    std::string by{};  ///< a name; empty where a file names nobody
    std::string at{};  ///< local time, as in "2026-11-30T21:02:43"; empty where a file has none

    friend bool operator==(const Approval&, const Approval&) = default;
};

/// What reviewers said of a structure.
struct Review {
    std::optional<Approval> approved{};  ///< unset: nobody approved it as it is
    std::string comment{};               ///< in words; may be empty
    bool locked = false;                 ///< whether no edit is to change it

    friend bool operator==(const Review&, const Review&) = default;
};

/// What files say about a structure beside its name and where it is. kontur carries it from file to file and computes
/// nothing with it.
struct StructureAttributes {
    std::optional<std::array<std::uint8_t, 3>> color{};  ///< red, green, blue
    std::string interpreted_type{};                      ///< "GTV", "ORGAN", "EXTERNAL", ...; may be empty
    std::string generation_algorithm{};                  ///< "AUTOMATIC", "SEMIAUTOMATIC", "MANUAL" or empty
    std::string description{};                           ///< in words; may be empty
    std::optional<std::int64_t> number{};                ///< of its ROI, by which plans and dose files name it
    std::optional<CodedConcept> category{};              ///< what sort of thing it is, such as tissue
    std::optional<CodedConcept> code{};                  ///< what it is, such as the liver
    std::vector<PhysicalProperty> physical_properties{};
    Review review{};

    friend bool operator==(const StructureAttributes&, const StructureAttributes&) = default;
};

/// What a structure says whose surface was fitted to what was drawn: the same, but for how it was made. Nobody has approved
/// or locked what was made now.
StructureAttributes fitted_attributes(StructureAttributes drawn);

/// A colour of levels from 0 to 1, which are cut to that, as bytes; to the nearest.
std::array<std::uint8_t, 3> to_rgb8(const std::array<double, 3>& levels);

/// The same colour as levels from 0 to 1.
std::array<double, 3> to_levels(const std::array<std::uint8_t, 3>& rgb);

}  // namespace kontur
