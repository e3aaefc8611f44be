// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kontur/shape/structure_attributes.h"

namespace kontur {

/// What a structure is, by terms of coding schemes.
struct SegmentTerms {
    std::optional<CodedConcept> category{};  ///< what sort of thing it is
    std::optional<CodedConcept> code{};      ///< what it is
};

/// The terms in the tags of a segment of a .seg.nrrd, NAME:VALUE with bars between them: those of "TerminologyEntry", by
/// 3D Slicer a list of contexts and terms, SCHEME^VALUE^MEANING, with tildes between them. Unset where there are none.
SegmentTerms terms_in_tags(std::string_view tags);

/// Tags that say the category and the code; "" without any. What would end a term or the list becomes a space.
std::string tags_of_terms(const StructureAttributes& said);

}  // namespace kontur
