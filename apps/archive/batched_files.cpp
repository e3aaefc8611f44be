// SPDX-License-Identifier: Apache-2.0
#include "archive/batched_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

// Few enough for a process that may open 1024 files, and to lose with a killed one.
constexpr std::size_t kMostFiles = 64;
constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;
/// Of who watches them come. With half and with twice of it a series takes as long.
constexpr std::chrono::milliseconds kLongestWait(500);

}  // namespace

BatchedFiles::~BatchedFiles() {
    for (const std::vector<File>* files : {&ended_, &open_})
        for (const File& file : *files) give_up(file);
}

void BatchedFiles::give_up(const File& file) const {
    ::close(file.descriptor);
    ::unlink(hidden(file).c_str());
}

void BatchedFiles::fail(const File& file, int reason) const {
    throw Error(ErrorKind::io,
                fmt::format("cannot write {}: {}", (folder_ / file.name).string(), std::generic_category().message(reason)));
}

void BatchedFiles::wait() {
    if (!ended_.empty() && std::chrono::steady_clock::now() - flushed_ >= kLongestWait) flush();
}

void BatchedFiles::begin(const std::string& name) {
    File file{name, -1};
    file.descriptor = ::open(hidden(file).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file.descriptor < 0) fail(file, errno);
    open_.push_back(file);
}

void BatchedFiles::write(std::string_view bytes) {
    wait();
    const File& file = open_.back();
    bytes_ += bytes.size();
    while (!bytes.empty()) {
        const ::ssize_t written = ::write(file.descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail(file, written < 0 ? errno : ENOSPC);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void BatchedFiles::end() {
    // The disk begins at once; a system that cannot has more to do later.
    ::sync_file_range(open_.back().descriptor, 0, 0, SYNC_FILE_RANGE_WRITE);
    ended_.push_back(open_.back());
    open_.pop_back();
    if (ended_.size() >= kMostFiles || bytes_ >= kMostBytes) flush();
    wait();
}

void BatchedFiles::flush() {
    // The first one waits for the journal, and with that for all of them.
    for (const File& file : ended_)
        if (::fsync(file.descriptor) != 0) fail(file, errno);
    while (!ended_.empty()) {
        const File file = ended_.back();
        if (::rename(hidden(file).c_str(), (folder_ / file.name).c_str()) != 0) fail(file, errno);
        ended_.pop_back();
        if (::close(file.descriptor) != 0) fail(file, errno);
    }
    bytes_ = 0;
    flushed_ = std::chrono::steady_clock::now();
}

}  // namespace kontur::archive
