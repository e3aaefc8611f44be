// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/zip.h"

#include <zlib.h>

#include <cstdint>
#include <limits>

#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

std::uint32_t checksum(const std::string& bytes) {
    return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void put(std::string& out, std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xFF);
}

/// What the header before a file and the one at the end have in common, from "version needed" to the name's length.
void put_description(std::string& out, const ZipEntry& entry) {
    constexpr std::uint32_t kVersion = 20, kFirstOfJanuary1980 = 0x21;
    const auto size = static_cast<std::uint32_t>(entry.bytes.size());
    put(out, kVersion, 2);
    put(out, 0, 2);  // flags
    put(out, 0, 2);  // stored
    put(out, 0, 2);  // time
    put(out, kFirstOfJanuary1980, 2);
    put(out, checksum(entry.bytes), 4);
    put(out, size, 4);
    put(out, size, 4);
    put(out, static_cast<std::uint32_t>(entry.name.size()), 2);
    put(out, 0, 2);  // extra field
}

}  // namespace

std::string zip(const std::vector<ZipEntry>& entries) {
    std::uint64_t whole = 22;
    for (const ZipEntry& entry : entries) whole += 76 + 2 * entry.name.size() + entry.bytes.size();
    if (whole > std::numeric_limits<std::uint32_t>::max() || entries.size() > 65'535)
        throw Error(ErrorKind::too_large, "an archive has room for 4 GiB and 65535 files, and these are more");
    std::string out, directory;
    for (const ZipEntry& entry : entries) {
        const auto offset = static_cast<std::uint32_t>(out.size());
        put(out, 0x04034b50, 4);
        put_description(out, entry);
        out += entry.name + entry.bytes;
        put(directory, 0x02014b50, 4);
        put(directory, 20, 2);  // made by
        put_description(directory, entry);
        put(directory, 0, 2);  // comment
        put(directory, 0, 2);  // disk
        put(directory, 0, 2);  // internal attributes
        put(directory, 0, 4);  // external attributes
        put(directory, offset, 4);
        directory += entry.name;
    }
    const auto begin = static_cast<std::uint32_t>(out.size());
    const auto count = static_cast<std::uint32_t>(entries.size());
    out += directory;
    put(out, 0x06054b50, 4);
    put(out, 0, 2);
    put(out, 0, 2);
    put(out, count, 2);
    put(out, count, 2);
    put(out, static_cast<std::uint32_t>(directory.size()), 4);
    put(out, begin, 4);
    put(out, 0, 2);
    return out;
}

}  // namespace kontur::viewer
