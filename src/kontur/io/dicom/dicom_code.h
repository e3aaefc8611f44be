// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: terms of coding schemes in DICOM files (PS3.3 section 8.8). Uses DCMTK's types.

#include <optional>
#include <string>
#include <vector>

#include "kontur/io/dicom/dcmtk.h"
#include "kontur/shape/structure_attributes.h"

namespace kontur::dcmtk {

/// The first term of a sequence; nullopt where that has none with a value and a scheme.
std::optional<CodedConcept> read_code(DcmItem& item, const DcmTagKey& sequence);

/// What DICOM has room for, nothing where that is none; notes, which `subject` begins, say what is left out or cut. A term
/// without words has its value as meaning. Throws Error(invalid_input) for a text that is no UTF-8.
std::optional<CodedConcept> storable(CodedConcept code, const std::string& subject, std::vector<std::string>& notes);

/// Appends a storable term.
void put_code(DcmItem& item, const DcmTagKey& sequence, const CodedConcept& code);

}  // namespace kontur::dcmtk
