// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_code.h"

#include <fmt/format.h>

#include "kontur/base/printable.h"
#include "kontur/io/dicom/dicom_document.h"
#include "kontur/io/dicom/dicom_names.h"

namespace kontur::dcmtk {
namespace {

constexpr std::size_t kMostShort = 16;   ///< bytes, of VR SH
constexpr std::size_t kMostLong = 64;    ///< characters, of VR LO
constexpr std::size_t kMostValue = 256;  ///< longer than any code in use

bool is_storable(const std::string& text, std::size_t most) { return !text.empty() && one_value(text, most) == text; }

}  // namespace

std::optional<CodedConcept> read_code(DcmItem& item, const DcmTagKey& sequence) {
    for (DcmItem* entry : items(item, sequence)) {
        CodedConcept code{text(*entry, DCM_CodeValue), text(*entry, DCM_CodingSchemeDesignator),
                          text(*entry, DCM_CodeMeaning)};
        if (code.value.empty()) code.value = text(*entry, DCM_LongCodeValue);
        if (!code.value.empty() && !code.scheme.empty()) return code;
    }
    return std::nullopt;
}

std::optional<CodedConcept> storable(CodedConcept code, const std::string& subject, std::vector<std::string>& notes) {
    for (const std::string* text : {&code.value, &code.scheme, &code.meaning}) check_utf8(*text, subject);
    if (!is_storable(code.value, kMostValue) || !is_storable(code.scheme, kMostShort)) {
        notes.push_back(
            fmt::format("{} is '{}' of '{}' and left out: DICOM has room for {} and {} characters without backslashes",
                        subject, shortened(printable_utf8(code.value), 100), shortened(printable_utf8(code.scheme), 100),
                        kMostValue, kMostShort));
        return std::nullopt;
    }
    if (code.meaning.empty()) code.meaning = one_value(code.value, kMostLong);
    else code.meaning = noted_value(code.meaning, kMostLong, "the meaning of " + subject, notes);
    return code;
}

void put_code(DcmItem& item, const DcmTagKey& sequence, const CodedConcept& code) {
    DcmItem& entry = append_item(item, sequence);
    put(entry, code.value.size() > kMostShort ? DCM_LongCodeValue : DCM_CodeValue, code.value);
    put(entry, DCM_CodingSchemeDesignator, code.scheme);
    put(entry, DCM_CodeMeaning, code.meaning);
}

}  // namespace kontur::dcmtk
