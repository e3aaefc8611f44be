// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: what to tell about the files that a volume was read without.

#include <string>
#include <vector>

#include "kontur/io/dicom/dicom_content.h"

namespace kontur {

struct DicomDoubts {
    std::vector<std::string> notes;     ///< files that cannot be slices of the volume
    std::vector<std::string> warnings;  ///< files that may be
};

/// About the files that are no part of `chosen`. May be slices of it: what is no DICOM file and is named like them, as an
/// interrupted copy is, and a damaged file that does not tell its series. Of damaged files in other series there is a
/// warning, too, unless the user named the series: he may have meant theirs.
DicomDoubts dicom_doubts(const DicomContent& content, const DicomStack& chosen, bool series_is_named);

}  // namespace kontur
