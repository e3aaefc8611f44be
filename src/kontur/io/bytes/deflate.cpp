// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <utility>

namespace kontur {
namespace {

constexpr int kMaxMemoryLevel = 9;
constexpr int kDenseLevel = 4, kQuickLevel = 1;

int window_bits(DeflateFormat format) {
    constexpr int kGzip = 16;
    return format == DeflateFormat::gzip ? MAX_WBITS + kGzip : MAX_WBITS;
}

}  // namespace

struct Deflater::Stream {
    z_stream z{};
    std::array<unsigned char, 1 << 16> out;
};

Deflater::Deflater(DeflateFormat format, Sink sink, DeflateMode mode)
    : stream_(std::make_unique<Stream>()), sink_(std::move(sink)) {
    const int level = mode == DeflateMode::quick ? kQuickLevel : kDenseLevel;
    const int strategy = mode == DeflateMode::runs ? Z_RLE : Z_DEFAULT_STRATEGY;
    if (::deflateInit2(&stream_->z, level, Z_DEFLATED, window_bits(format), kMaxMemoryLevel, strategy) != Z_OK)
        throw std::bad_alloc();
}

Deflater::~Deflater() { ::deflateEnd(&stream_->z); }

void Deflater::write(std::span<const std::byte> bytes) {
    constexpr std::size_t kMaxStep = std::size_t{1} << 30;
    while (!bytes.empty()) {
        const auto step = bytes.first(std::min(bytes.size(), kMaxStep));
        // zlib reads through a pointer that lacks const unless ZLIB_CONST is set everywhere.
        stream_->z.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(step.data()));
        stream_->z.avail_in = static_cast<uInt>(step.size());
        run(Z_NO_FLUSH);
        bytes = bytes.subspan(step.size());
    }
}

void Deflater::finish() { run(Z_FINISH); }

void Deflater::run(int flush) {
    z_stream& z = stream_->z;
    do {
        z.next_out = stream_->out.data();
        z.avail_out = static_cast<uInt>(stream_->out.size());
        ::deflate(&z, flush);
        sink_(stream_->out.data(), stream_->out.size() - z.avail_out);
    } while (z.avail_out == 0);
}

}  // namespace kontur
