// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace kontur {

/// Makes the folder, and those above it, if it is not there. Throws Error(io) naming it and the system's reason.
void make_folder(const std::filesystem::path& folder);

/// Where the user's programs keep what he did not place himself (the XDG base directory specification): the folder that the
/// environment's `variable` names, or else this one below his home. nullopt: the environment says neither.
std::optional<std::filesystem::path> user_folder(const char* variable, const std::filesystem::path& below_home);

}  // namespace kontur
