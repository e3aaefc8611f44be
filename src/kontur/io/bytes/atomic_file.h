// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace kontur {

/// Where the bytes of a file of this name belong: what a chain of symbolic links names, whether it exists or not, since a
/// rename would replace the link itself. Throws Error(io) for links that lead in a circle or cannot be read.
std::filesystem::path link_destination(const std::filesystem::path& target);

/// A file that appears whole or not at all: bytes go to a file without a name in the target's folder, and only `commit` puts
/// it in the target's place. Without a commit (an exception, a full disk, a killed process) nothing is left of it, and an
/// existing target stays as it was. Where the file system knows no such files (NFS), it has a temporary name, which a killed
/// process leaves behind. A symbolic link is followed; a target that exists and is no regular file is refused.
/// All members throw Error(io) naming the target and the system's reason.
class AtomicFile {
public:
    explicit AtomicFile(const std::filesystem::path& target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* bytes, std::size_t count);
    void write(std::string_view text) { write(text.data(), text.size()); }

    /// For libraries that write to a path by themselves: gives the file a temporary name, with the target's extension. Not
    /// to be mixed with `write`.
    const std::filesystem::path& temporary_path();

    /// Flushes to the disk and renames. Call once, last.
    void commit();

private:
    /// Calls `make` with a temporary name until it does not fail for one that exists.
    void take_name(const std::function<int(const char*)>& make);
    void flush();
    void write_through(const char* bytes, std::size_t count);
    [[noreturn]] void fail(int reason) const;

    std::filesystem::path target_;
    std::filesystem::path temporary_;  ///< empty: the file has no name
    std::string buffer_;
    int descriptor_ = -1;
    bool committed_ = false;
};

/// Opens, calls `writer`, commits.
void write_file_atomically(const std::filesystem::path& target, const std::function<void(AtomicFile&)>& writer);

/// A file with exactly these bytes.
void write_file_atomically(const std::filesystem::path& target, std::string_view bytes);

}  // namespace kontur
