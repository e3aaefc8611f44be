// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

namespace kontur::test {

/// Counts how often the files of one folder are opened, by whatever program.
class FileOpens {
public:
    explicit FileOpens(const std::filesystem::path& folder) : watch_(::inotify_init1(IN_NONBLOCK)) {
        if (watch_ < 0 || ::inotify_add_watch(watch_, folder.c_str(), IN_OPEN) < 0)
            throw std::runtime_error("cannot watch " + folder.string() + ": " + std::strerror(errno));
    }
    FileOpens(const FileOpens&) = delete;
    FileOpens& operator=(const FileOpens&) = delete;
    ~FileOpens() { ::close(watch_); }

    /// Since the last call, by the names of files.
    std::map<std::string, int> counts() {
        std::map<std::string, int> found;
        alignas(inotify_event) std::array<char, 1 << 16> buffer;
        for (ssize_t size; (size = ::read(watch_, buffer.data(), buffer.size())) > 0;)
            for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
                inotify_event event;
                std::memcpy(&event, buffer.data() + at, sizeof(event));
                if (event.mask & IN_Q_OVERFLOW) throw std::runtime_error("too many files were opened to count them");
                if (event.len > 0 && !(event.mask & IN_ISDIR)) ++found[buffer.data() + at + sizeof(event)];
                at += sizeof(event) + event.len;
            }
        return found;
    }

private:
    int watch_;
};

}  // namespace kontur::test
