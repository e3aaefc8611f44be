// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "kontur/base/error.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
constexpr int kNameAttempts = 1000;
constexpr const char* kDescriptors = "/proc/self/fd";

[[noreturn]] void fail_to_write(const fs::path& target, const std::string& reason) {
    throw Error(ErrorKind::io, "cannot write " + target.string() + ": " + reason);
}

void refuse_special_file(const fs::path& target) {
    std::error_code error;
    const fs::file_status status = fs::status(target, error);
    if (fs::is_directory(status)) fail_to_write(target, "it is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) fail_to_write(target, "it is no regular file");
}

/// A short name of its own, so that a long target name does not exceed the file system's limit.
fs::path temporary_name(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    const std::string name = ".kontur-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
    return target.parent_path() / (name + target.extension().string());
}

fs::path folder_of(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

/// The rename itself reaches the disk only with its folder. Best effort: some file systems cannot do it.
void sync_folder(const fs::path& target) {
    const int descriptor = ::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

}  // namespace

fs::path link_destination(const fs::path& target) {
    constexpr int kMostLinks = 40;  // as many as Linux follows
    fs::path path = target;
    std::error_code error;
    for (int links = 0; fs::is_symlink(fs::symlink_status(path, error)); ++links) {
        if (links == kMostLinks) fail_to_write(target, std::generic_category().message(ELOOP));
        const fs::path next = fs::read_symlink(path, error);
        if (error) fail_to_write(target, error.message());
        path = path.parent_path() / next;
    }
    return path;
}

AtomicFile::AtomicFile(const fs::path& target) : target_(link_destination(target)) {
    refuse_special_file(target_);
    // Without /proc such a file could never get a name.
    if (::access(kDescriptors, X_OK) == 0)
        descriptor_ = ::open(folder_of(target_).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
        take_name(
            [&](const char* name) { return descriptor_ = ::open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
    struct stat existing {};
    if (::stat(target_.c_str(), &existing) == 0) ::fchmod(descriptor_, existing.st_mode & 07777);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!committed_ && !temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::take_name(const std::function<int(const char*)>& make) {
    for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
        const fs::path name = temporary_name(target_);
        if (make(name.c_str()) >= 0) {
            temporary_ = name;
            return;
        }
        if (errno != EEXIST) fail(errno);
    }
    fail(EEXIST);
}

const fs::path& AtomicFile::temporary_path() {
    const fs::path file = fs::path(kDescriptors) / std::to_string(descriptor_);
    if (temporary_.empty())
        take_name([&](const char* name) { return ::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW); });
    return temporary_;
}

void AtomicFile::write(const void* bytes, std::size_t count) {
    if (buffer_.size() + count > kBufferBytes) flush();
    if (count > kBufferBytes) write_through(static_cast<const char*>(bytes), count);
    else buffer_.append(static_cast<const char*>(bytes), count);
}

void AtomicFile::flush() {
    write_through(buffer_.data(), buffer_.size());
    buffer_.clear();
}

void AtomicFile::write_through(const char* bytes, std::size_t count) {
    while (count > 0) {
        const ::ssize_t written = ::write(descriptor_, bytes, count);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail(written < 0 ? errno : ENOSPC);
        bytes += written;
        count -= static_cast<std::size_t>(written);
    }
}

void AtomicFile::commit() {
    flush();
    if (::fsync(descriptor_) != 0) fail(errno);
    temporary_path();  // a link cannot replace a file that is there; a rename can
    // Network file systems report a full disk only here.
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno);
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
    committed_ = true;
    sync_folder(target_);
}

void AtomicFile::fail(int reason) const { fail_to_write(target_, std::generic_category().message(reason)); }

void write_file_atomically(const fs::path& target, const std::function<void(AtomicFile&)>& writer) {
    AtomicFile file(target);
    writer(file);
    file.commit();
}

void write_file_atomically(const fs::path& target, std::string_view bytes) {
    write_file_atomically(target, [&](AtomicFile& file) { file.write(bytes); });
}

}  // namespace kontur
