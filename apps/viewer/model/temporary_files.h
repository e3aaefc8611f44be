// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kontur::viewer {

/// A folder of its own for files that only live for one call; removed with all that is in it. Nobody else may look into it.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    int owner_ = -1;  ///< holds the lock that says whose it is
};

/// Removes the folders of processes that were killed.
void remove_left_folders();

/// All bytes of a file. Throws Error(io).
std::string read_bytes(const std::filesystem::path& path);

}  // namespace kontur::viewer
