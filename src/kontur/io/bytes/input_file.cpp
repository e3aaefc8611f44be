// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "kontur/base/error.h"

namespace kontur {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
constexpr std::uint64_t kMaxSkippedBytes = std::uint64_t{1} << 28;
constexpr std::size_t kMaxTrailingBytes = std::size_t{1} << 20;

[[noreturn]] void fail_to_read(const std::filesystem::path& path, const std::string& reason) {
    throw Error(ErrorKind::io, "cannot read " + path.string() + ": " + reason);
}

[[noreturn]] void fail_corrupt(const std::filesystem::path& path, const std::string& reason) {
    throw Error(ErrorKind::corrupt_file, path.string() + ": " + reason);
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& path)
    : path_(path), buffer_(std::make_unique_for_overwrite<unsigned char[]>(kBufferBytes)) {
    // Without O_NONBLOCK, opening a pipe would wait for its writer.
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0) fail_to_read(path, std::generic_category().message(errno));
    struct stat status {};
    const bool known = ::fstat(descriptor_, &status) == 0;
    if (known && S_ISREG(status.st_mode)) {
        stored_bytes_ = static_cast<std::uint64_t>(status.st_size);
        return;
    }
    ::close(descriptor_);
    fail_to_read(path, known && S_ISDIR(status.st_mode) ? "it is a folder" : "it is no regular file");
}

InputFile::~InputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      stored_bytes_(other.stored_bytes_),
      fetched_(other.fetched_),
      buffer_(std::move(other.buffer_)),
      buffer_begin_(other.buffer_begin_),
      buffer_end_(other.buffer_end_),
      inflater_(std::move(other.inflater_)),
      inflated_(other.inflated_),
      declared_(other.declared_),
      delivered_(other.delivered_) {}

std::size_t InputFile::fetch(void* to, std::size_t count) {
    ::ssize_t got;
    do got = ::read(descriptor_, to, std::min<std::size_t>(count, std::size_t{1} << 30));
    while (got < 0 && errno == EINTR);
    if (got < 0) fail_to_read(path_, std::generic_category().message(errno));
    fetched_ += static_cast<std::uint64_t>(got);
    // A file that grows while it is read is read to the end it has now.
    stored_bytes_ = std::max(stored_bytes_, fetched_);
    return static_cast<std::size_t>(got);
}

bool InputFile::fill(std::size_t least) {
    const std::size_t count = buffer_end_ - buffer_begin_;
    if (count >= least) return true;
    std::memmove(buffer_.get(), buffer_.get() + buffer_begin_, count);
    buffer_begin_ = 0;
    buffer_end_ = count;
    while (buffer_end_ < least) {
        const std::size_t got = fetch(buffer_.get() + buffer_end_, kBufferBytes - buffer_end_);
        if (got == 0) return false;
        buffer_end_ += got;
    }
    return true;
}

bool InputFile::at(std::string_view mark) {
    return fill(mark.size()) && std::memcmp(buffer_.get() + buffer_begin_, mark.data(), mark.size()) == 0;
}

bool InputFile::at_gzip() { return at("\x1f\x8b"); }
bool InputFile::at_bzip2() { return at("BZh"); }

void InputFile::inflate() { inflater_ = make_inflater(Inflation::gzip_or_zlib); }
void InputFile::inflate_raw() { inflater_ = make_inflater(Inflation::raw); }
void InputFile::bunzip2() { inflater_ = make_bunzip2(); }

std::optional<std::string> InputFile::read_line(std::size_t max_length) {
    std::string line;
    while (fill()) {
        const auto* begin = buffer_.get() + buffer_begin_;
        const auto* end = static_cast<const unsigned char*>(std::memchr(begin, '\n', buffer_end_ - buffer_begin_));
        const std::size_t length = end ? static_cast<std::size_t>(end - begin) : buffer_end_ - buffer_begin_;
        if (line.size() + length > max_length)
            fail_corrupt(path_, "a header line is longer than " + std::to_string(max_length) + " bytes");
        line.append(reinterpret_cast<const char*>(begin), length);
        buffer_begin_ += length + (end ? 1 : 0);
        if (!end) continue;
        if (line.ends_with('\r')) line.pop_back();
        return line;
    }
    if (line.empty()) return std::nullopt;
    return line;
}

void InputFile::expect(std::uint64_t declared) {
    const std::uint64_t stored = stored_bytes_left();
    if (!inflater_ && declared > stored)
        fail_corrupt(path_, "its header declares " + std::to_string(declared) + " bytes of voxels, but only " +
                                std::to_string(stored) + " are there");
    if (inflater_ && declared / inflater_->most_inflation() > stored)
        fail_corrupt(path_, "its header declares " + std::to_string(declared) + " bytes of voxels, more than the " +
                                std::to_string(stored) + " compressed bytes there can hold");
    declared_ = declared;
    delivered_ = 0;
}

void InputFile::read(void* to, std::size_t count) {
    if (read_some(to, count) != count) fail_short();
}

std::size_t InputFile::read_some(void* to, std::size_t count) {
    const std::size_t got = inflater_ ? read_inflated(static_cast<unsigned char*>(to), count) : read_stored(to, count);
    delivered_ += got;
    return got;
}

std::size_t InputFile::read_stored(void* to, std::size_t count) {
    auto* next = static_cast<unsigned char*>(to);
    std::size_t left = count;
    while (left > 0) {
        std::size_t got;
        if (buffer_begin_ == buffer_end_ && left >= kBufferBytes) {
            got = fetch(next, left);
        } else {
            if (!fill()) break;
            got = std::min(left, buffer_end_ - buffer_begin_);
            std::memcpy(next, buffer_.get() + buffer_begin_, got);
            buffer_begin_ += got;
        }
        if (got == 0) break;
        next += got;
        left -= got;
    }
    return count - left;
}

std::size_t InputFile::read_inflated(unsigned char* to, std::size_t count) {
    std::size_t left = count;
    while (left > 0 && !inflated_) {
        if (!fill()) fail_short();
        const Decompressor::Step step = inflater_->run(std::span(buffer_.get() + buffer_begin_, buffer_end_ - buffer_begin_),
                                                       std::span(to + (count - left), left));
        buffer_begin_ += step.consumed;
        left -= step.produced;
        if (step.damage) fail_corrupt(path_, std::string("its compressed data are damaged: ") + step.damage);
        if (step.consumed + step.produced == 0 && !step.ended)
            fail_corrupt(path_, "its compressed data are damaged: no end");
        if (step.ended) inflated_ = !next_member();
    }
    return count - left;
}

bool InputFile::next_member() {
    fill(Decompressor::kMarkBytes);
    return inflater_->begins_again(std::span(buffer_.get() + buffer_begin_, buffer_end_ - buffer_begin_));
}

void InputFile::skip(std::uint64_t count) {
    if (inflater_) {
        if (!declared_ && count > kMaxSkippedBytes)
            fail_corrupt(path_, "its voxels start at byte " + std::to_string(count) + " of its compressed data; at most " +
                                    std::to_string(kMaxSkippedBytes) + " are skipped");
        std::vector<unsigned char> discarded(std::min<std::uint64_t>(count, kBufferBytes));
        for (std::uint64_t left = count; left > 0; left -= std::min<std::uint64_t>(left, discarded.size()))
            read(discarded.data(), std::min<std::uint64_t>(left, discarded.size()));
        return;
    }
    if (count > stored_bytes_left()) fail_short();
    delivered_ += count;
    const std::uint64_t buffered = std::min<std::uint64_t>(count, buffer_end_ - buffer_begin_);
    buffer_begin_ += buffered;
    if (count == buffered) return;
    if (::lseek(descriptor_, static_cast<::off_t>(count - buffered), SEEK_CUR) < 0)
        fail_to_read(path_, std::generic_category().message(errno));
    fetched_ += count - buffered;
}

void InputFile::finish() {
    if (!inflater_) return;
    std::vector<unsigned char> trailing(kBufferBytes);
    std::size_t total = 0;
    while (!inflated_) {
        total += read_inflated(trailing.data(), trailing.size());
        if (total > kMaxTrailingBytes)
            fail_corrupt(path_, "more than " + std::to_string(kMaxTrailingBytes) + " bytes follow its last voxel");
    }
}

void InputFile::fail_short() const {
    if (!declared_) fail_corrupt(path_, "it ends after " + std::to_string(delivered_) + " bytes, within its header");
    fail_corrupt(path_, "its header declares " + std::to_string(*declared_) + " bytes of voxels, but it ends after " +
                            std::to_string(delivered_));
}

std::filesystem::path path_beside(const std::filesystem::path& header, const std::string& declared) {
    const std::string name = declared.substr(declared.starts_with("./") ? 2 : 0);
    if (name.empty()) throw Error(ErrorKind::corrupt_file, header.string() + ": it names no file for its voxels");
    if (name == "." || name == ".." || name.find_first_of("/\\") != std::string::npos)
        throw Error(
            ErrorKind::unsupported,
            header.string() + ": its voxels are in \"" + declared +
                "\"; only a plain file name in the header's own folder is accepted; put the file there and name it so");
    return header.parent_path() / name;
}

InputFile open_beside(const std::filesystem::path& header, const std::string& declared) {
    return InputFile(path_beside(header, declared));
}

}  // namespace kontur
