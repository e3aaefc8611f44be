// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/temporary_files.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string_view>
#include <system_error>

#include "kontur/base/error.h"

namespace kontur::viewer {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPattern = "kontur-XXXXXX";
constexpr const char* kOwner = ".owner";  ///< locked as long as the process lives that made the folder

}  // namespace

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / kPattern).string();
    if (!mkdtemp(name.data()))
        throw Error(ErrorKind::io, "cannot make a temporary folder: " + std::generic_category().message(errno));
    path_ = name;
    // Locked before it has its name: whoever finds it unlocked may remove the folder. Without it the folder only stays.
    const fs::path owner = path_ / kOwner, before = path_ / ".new";
    owner_ = open(before.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (owner_ >= 0 && flock(owner_, LOCK_EX | LOCK_NB) == 0) rename(before.c_str(), owner.c_str());
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    if (owner_ >= 0) close(owner_);
}

void remove_left_folders() {
    std::error_code error, ignored;
    const fs::path parent = fs::temp_directory_path(error);
    for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
        const fs::path& folder = entry->path();
        const std::string name = folder.filename().string();
        if (name.size() != kPattern.size() || !name.starts_with(kPattern.substr(0, kPattern.find('X')))) continue;
        struct stat status = {};
        if (lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != geteuid()) continue;
        const int owner = open((folder / kOwner).c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
        if (owner < 0) continue;
        if (flock(owner, LOCK_EX | LOCK_NB) == 0) fs::remove_all(folder, ignored);
        close(owner);
    }
}

std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(path)), '\0');
    if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        throw Error(ErrorKind::io, "cannot read " + path.string());
    return bytes;
}

}  // namespace kontur::viewer
