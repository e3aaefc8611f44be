// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/gzip.h"

#include "kontur/io/bytes/deflate.h"

namespace kontur::viewer {

std::string gzipped(std::string_view bytes) {
    std::string packed;
    Deflater deflater(
        DeflateFormat::gzip,
        [&](const void* data, std::size_t count) { packed.append(static_cast<const char*>(data), count); },
        DeflateMode::quick);
    deflater.write(std::as_bytes(std::span(bytes)));
    deflater.finish();
    return packed;
}

}  // namespace kontur::viewer
