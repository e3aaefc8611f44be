// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace kontur {

/// Compressed bytes in, plain bytes out, piece by piece. Internal to io.
class Decompressor {
public:
    struct Step {
        std::size_t consumed = 0, produced = 0;
        bool ended = false;            ///< the stream's checksum was right, where it has one
        const char* damage = nullptr;  ///< why it cannot go on
    };

    virtual ~Decompressor() = default;
    virtual Step run(std::span<const unsigned char> in, std::span<unsigned char> out) = 0;
    /// After the end: whether another stream begins with these bytes, as parallel compressors write them. If so, goes on.
    virtual bool begins_again(std::span<const unsigned char> next) = 0;
    /// How many bytes one can become.
    virtual std::uint64_t most_inflation() const = 0;
    /// Bytes that `begins_again` wants to see.
    static constexpr std::size_t kMarkBytes = 3;
};

enum class Inflation { gzip_or_zlib, raw };
std::unique_ptr<Decompressor> make_inflater(Inflation format);
std::unique_ptr<Decompressor> make_bunzip2();

}  // namespace kontur
