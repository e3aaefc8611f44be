// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewer/files/imports.h"

namespace kontur::viewer {

/// What a file holds, read here and now; `import_apart` does that in a process of its own. Throws as the readers do, and
/// Error(invalid_input) or Error(too_large) for a file with nothing, or too much, to import.
ImportContent read_import(const std::filesystem::path& path, const Upload& upload);

}  // namespace kontur::viewer
