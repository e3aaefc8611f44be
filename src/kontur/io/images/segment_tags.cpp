// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/segment_tags.h"

#include <algorithm>
#include <vector>

#include "kontur/base/printable.h"

namespace kontur {
namespace {

constexpr std::string_view kEntry = "TerminologyEntry:";
// Names of lists of terms that 3D Slicer brings: it looks them up by these names, and shows terms of other lists, too.
constexpr std::string_view kTypeContext = "Segmentation category and type - 3D Slicer General Anatomy list";
constexpr std::string_view kAnatomyContext = "Anatomic codes - DICOM master list";
/// Most segments that are tissue say no more; so do those of which nothing is known.
const CodedConcept kTissue{"85756007", "SCT", "Tissue"};

std::vector<std::string_view> parts_of(std::string_view text, char between) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0;;) {
        const std::size_t end = text.find(between, begin);
        parts.push_back(text.substr(begin, end - begin));
        if (end == std::string_view::npos) return parts;
        begin = end + 1;
    }
}

std::optional<CodedConcept> term_in(std::string_view text) {
    const std::vector<std::string_view> parts = parts_of(text, '^');
    if (parts.size() != 3 || parts[0].empty() || parts[1].empty()) return std::nullopt;
    const auto utf8 = [](std::string_view part) {
        return is_utf8(part) ? std::string(part) : latin1_to_utf8(std::string(part));
    };
    return CodedConcept{utf8(parts[1]), utf8(parts[0]), utf8(parts[2])};
}

std::string text_of(const std::optional<CodedConcept>& term) {
    if (!term) return "^^";
    std::string text;
    for (const std::string* part : {&term->scheme, &term->value, &term->meaning}) {
        std::string plain = *part;
        std::replace_if(
            plain.begin(), plain.end(), [](char c) { return c == '|' || c == '~' || c == '^'; }, ' ');
        text += (text.empty() ? "" : "^") + plain;
    }
    return text;
}

}  // namespace

SegmentTerms terms_in_tags(std::string_view tags) {
    for (const std::string_view tag : parts_of(tags, '|')) {
        if (!tag.starts_with(kEntry)) continue;
        const std::vector<std::string_view> parts = parts_of(tag.substr(kEntry.size()), '~');
        SegmentTerms terms;
        if (parts.size() > 1) terms.category = term_in(parts[1]);
        if (parts.size() > 2) terms.code = term_in(parts[2]);
        return terms;
    }
    return {};
}

std::string tags_of_terms(const StructureAttributes& said) {
    if (!said.category && !said.code) return "";
    // An entry without either of them is none for 3D Slicer.
    const std::string category = text_of(said.category ? said.category : kTissue);
    const std::string code = text_of(said.code ? said.code : kTissue);
    return std::string(kEntry) + std::string(kTypeContext) + "~" + category + "~" + code + "~^^~" +
           std::string(kAnatomyContext) + "~^^~^^|";
}

}  // namespace kontur
