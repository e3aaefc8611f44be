// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kontur/shape/provenance.h"

namespace kontur {

/// What kontur wrote into the file about how it was made: in the order written, that of JSON and NRRD by name. Empty for
/// files that say nothing, of other programs or of an unknown format, and for folders. MetaImage and STL, which hold it
/// shortened, give one entry, "shortened". Names that are no words are left out; control characters and bytes that are no
/// UTF-8 become '?', so that it can be written again. Throws Error(io) for a file that cannot be read, and
/// Error(corrupt_file) where its reader would.
Provenance read_provenance(const std::filesystem::path& path);

}  // namespace kontur
