// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/folders.h"

#include <fmt/format.h>

#include <cstdlib>
#include <system_error>

#include "kontur/base/error.h"

namespace kontur {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) throw Error(ErrorKind::io, fmt::format("cannot make {}: {}", folder.string(), failure.message()));
}

std::optional<fs::path> user_folder(const char* variable, const fs::path& below_home) {
    const char *named = std::getenv(variable), *home = std::getenv("HOME");
    if (named && fs::path(named).is_absolute()) return named;
    if (home && fs::path(home).is_absolute()) return fs::path(home) / below_home;
    return std::nullopt;
}

}  // namespace kontur
