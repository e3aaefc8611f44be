// SPDX-License-Identifier: Apache-2.0
#include "viewer/temporary_files.h"

#include <stdlib.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "kontur/base/error.h"

namespace kontur::viewer {

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "kontur-XXXXXX").string();
    if (!mkdtemp(name.data()))
        throw Error(ErrorKind::io, "cannot make a temporary folder: " + std::generic_category().message(errno));
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(path)), '\0');
    if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        throw Error(ErrorKind::io, "cannot read " + path.string());
    return bytes;
}

}  // namespace kontur::viewer
