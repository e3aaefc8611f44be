// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "kontur/base/work.h"
#include "viewer/files/imports.h"

// The process that reads a foreign file: this program once more, with limits on memory and time.

namespace kontur::viewer {

/// Of the server: starts it in the folder, waits for its end, and kills it where it is no longer wanted. Returns its status
/// as `waitpid` tells it. Throws Error(io) where it cannot be started, and Error(too_large) where it takes minutes.
int run_import_process(const Upload& upload, const std::filesystem::path& folder, const Work& work);

/// Throws Error(too_large) for the status of one that was ended because it computed for too long.
void check_ended_in_time(int status);

/// Of that process, before it opens the file: puts on the limits, and returns what it is to read. nullopt for a command line
/// that no server has made.
std::optional<Upload> begin_import_process(int argc, char** argv);

}  // namespace kontur::viewer
