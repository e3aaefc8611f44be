// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

namespace kontur {

enum class DeflateFormat { gzip, zlib };

/// Compresses to a sink. The same input gives the same bytes: a gzip header without time and name. Internal.
class Deflater {
public:
    using Sink = std::function<void(const void* bytes, std::size_t count)>;

    /// Its level is for large files: about three times as fast as zlib's default of 6 on CT, some per cent larger.
    Deflater(DeflateFormat format, Sink sink, int level = 4);
    ~Deflater();
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;

    void write(std::span<const std::byte> bytes);
    /// Call once, last.
    void finish();

private:
    struct Stream;
    void run(int flush);

    std::unique_ptr<Stream> stream_;
    Sink sink_;
};

}  // namespace kontur
