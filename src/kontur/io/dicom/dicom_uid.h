// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: identifiers of the DICOM objects that kontur makes.

#include <string>

namespace kontur {

/// A new unique identifier: "2.25." and a random UUID (version 4) as a decimal number (DICOM PS3.5 B.2). Random rather than
/// made from host, process and time: jobs in containers share these.
std::string new_uid();

}  // namespace kontur
