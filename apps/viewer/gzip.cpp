// SPDX-License-Identifier: Apache-2.0
#include "viewer/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "kontur/base/error.h"

namespace kontur::viewer {

std::string gzipped(std::string_view bytes) {
    constexpr int kGzip = 15 + 16, kMemory = 8;
    z_stream stream{};
    if (bytes.size() > std::numeric_limits<uInt>::max() ||
        deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw Error(ErrorKind::too_large, "a reply cannot be compressed");
    std::string packed(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(std::min<std::size_t>(packed.size(), std::numeric_limits<uInt>::max()));
    const int result = deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    if (result != Z_STREAM_END) throw Error(ErrorKind::too_large, "a reply cannot be compressed");
    return packed;
}

}  // namespace kontur::viewer
