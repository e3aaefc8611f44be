// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

namespace kontur {

enum class DeflateFormat { gzip, zlib };

enum class DeflateMode {
    dense,  ///< for images: about three times as fast as zlib's default of 6 on CT, some per cent larger
    runs,   ///< looks for runs of one byte only: for masks of one byte to a voxel half of the time, and smaller
    quick,  ///< for what is sent over a fast line
};

/// Compresses to a sink. The same input gives the same bytes: a gzip header without time and name. Internal.
class Deflater {
public:
    using Sink = std::function<void(const void* bytes, std::size_t count)>;

    Deflater(DeflateFormat format, Sink sink, DeflateMode mode = DeflateMode::dense);
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
