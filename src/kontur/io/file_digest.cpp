// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/file_digest.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_folder.h"
#include "kontur/shape/sha256.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, const char* reason) {
    throw Error(ErrorKind::io, "cannot read " + path.string() + ": " + reason);
}

std::string digest_of_file(const fs::path& path, const Work& work) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) fail(path, std::strerror(errno));
    Sha256 hash;
    std::vector<std::byte> buffer(std::size_t{1} << 20);
    for (;;) {
        const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get());
        hash.update(std::span(buffer).first(count));
        if (count < buffer.size()) break;
        work.check();
    }
    if (std::ferror(file.get())) fail(path, std::strerror(errno));
    return hash.hex();
}

std::string digest_of(const std::vector<std::string>& digests) {
    Sha256 hash;
    std::string lines;
    for (const std::string& digest : digests) lines += digest + "\n";
    hash.update(std::as_bytes(std::span(lines)));
    return hash.hex();
}

}  // namespace

std::string file_sha256(const fs::path& path, const Work& work) {
    std::error_code failure;
    const fs::file_status status = fs::status(path, failure);
    if (fs::is_other(status)) fail(path, "it is a device or a pipe, not a file");  // devices may never end
    if (!fs::is_directory(status)) return digest_of_file(path, work);
    std::vector<std::string> digests;
    for (const fs::path& file : dicom_folder(path).files) digests.push_back(digest_of_file(file, work));
    std::sort(digests.begin(), digests.end());
    return digest_of(digests);
}

std::string files_sha256(const std::vector<fs::path>& paths, const Work& work) {
    std::vector<std::string> digests;
    digests.reserve(paths.size());
    for (const fs::path& path : paths) digests.push_back(file_sha256(path, work));
    return digests.size() == 1 ? digests.front() : digest_of(digests);
}

}  // namespace kontur
