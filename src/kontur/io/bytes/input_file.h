// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "kontur/io/bytes/decompress.h"

namespace kontur {

/// A file read from front to back and inflated on the way where it is compressed. Internal to io. Members throw Error(io)
/// when the system refuses and Error(corrupt_file) when the file holds less than was asked for.
class InputFile {
public:
    /// Opens a regular file; devices, pipes and folders are refused, so that a size is known before anything is read.
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(InputFile&&) noexcept;
    InputFile& operator=(InputFile&&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// Bytes on the disk behind the current position, compressed ones as they are.
    std::uint64_t stored_bytes_left() const { return stored_bytes_ - fetched_ + (buffer_end_ - buffer_begin_); }

    /// True when the next bytes are a gzip member.
    bool at_gzip();
    /// True when the next bytes are a bzip2 stream.
    bool at_bzip2();
    /// What follows is a gzip or a zlib stream; `read` delivers its content.
    void inflate();
    /// The same for bzip2.
    void bunzip2();
    /// What follows is a deflate stream without a head, as in deflated DICOM.
    void inflate_raw();

    /// The next line without its end (LF or CRLF), nullopt at the end of the file. Not for compressed content.
    std::optional<std::string> read_line(std::size_t max_length);

    /// Announces that `declared` bytes of voxels follow. Throws before anyone allocates for them if the file is too short,
    /// or too short to have been compressed from that many (deflate shrinks by no more than 1032, bzip2 by some millions).
    void expect(std::uint64_t declared);

    /// Exactly `count` bytes.
    void read(void* to, std::size_t count);
    /// Up to `count` bytes; fewer only at the end of the file.
    std::size_t read_some(void* to, std::size_t count);
    /// Of compressed content before `expect` only 256 MiB: a header that says more is a lie that would be long to follow.
    void skip(std::uint64_t count);

    /// Verifies the checksum behind compressed content.
    void finish();

private:
    /// False when the file has fewer than `least` bytes left, which then are in the buffer.
    bool fill(std::size_t least = 1);
    std::size_t fetch(void* to, std::size_t count);
    std::size_t read_stored(void* to, std::size_t count);
    std::size_t read_inflated(unsigned char* to, std::size_t count);
    bool next_member();
    bool at(std::string_view mark);
    [[noreturn]] void fail_short() const;

    std::filesystem::path path_;
    int descriptor_ = -1;
    std::uint64_t stored_bytes_ = 0;
    std::uint64_t fetched_ = 0;  ///< bytes taken from the descriptor
    std::unique_ptr<unsigned char[]> buffer_;
    std::size_t buffer_begin_ = 0, buffer_end_ = 0;
    std::unique_ptr<Decompressor> inflater_;
    bool inflated_ = false;  ///< to its end
    std::optional<std::uint64_t> declared_;
    std::uint64_t delivered_ = 0;  ///< since `expect`, else since the start
};

/// A data file that a header names. Only a plain name in the header's own folder, "./" before it or not, is accepted: a
/// header from elsewhere must not make any other file's content into voxels. Throws Error(unsupported) for anything with a
/// path in it.
std::filesystem::path path_beside(const std::filesystem::path& header, const std::string& declared);
InputFile open_beside(const std::filesystem::path& header, const std::string& declared);

}  // namespace kontur
