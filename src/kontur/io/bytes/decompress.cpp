// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/decompress.h"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <new>

namespace kontur {
namespace {

constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;  ///< the libraries count by 32 bits

class Inflater : public Decompressor {
public:
    explicit Inflater(int window_bits) {
        if (::inflateInit2(&stream_, window_bits) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() override { ::inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    Step run(std::span<const unsigned char> in, std::span<unsigned char> out) override {
        // zlib reads through a pointer that lacks const unless ZLIB_CONST is set everywhere.
        stream_.next_in = const_cast<unsigned char*>(in.data());
        const auto given = static_cast<uInt>(std::min(in.size(), kMostAtOnce));
        const auto room = static_cast<uInt>(std::min(out.size(), kMostAtOnce));
        stream_.avail_in = given;
        stream_.next_out = out.data();
        stream_.avail_out = room;
        const int status = ::inflate(&stream_, Z_NO_FLUSH);
        Step step{given - stream_.avail_in, room - stream_.avail_out, status == Z_STREAM_END, nullptr};
        if (status != Z_OK && status != Z_BUF_ERROR && status != Z_STREAM_END)
            step.damage = stream_.msg ? stream_.msg : "inflate failed";
        return step;
    }

    bool begins_again(std::span<const unsigned char> next) override {
        return next.size() >= 2 && next[0] == 0x1f && next[1] == 0x8b && ::inflateReset(&stream_) == Z_OK;
    }

    std::uint64_t most_inflation() const override { return 1100; }  // deflate's limit is 1032

private:
    z_stream stream_{};
};

class Bunzip2 : public Decompressor {
public:
    Bunzip2() { begin(); }
    ~Bunzip2() override { ::BZ2_bzDecompressEnd(&stream_); }
    Bunzip2(const Bunzip2&) = delete;
    Bunzip2& operator=(const Bunzip2&) = delete;

    Step run(std::span<const unsigned char> in, std::span<unsigned char> out) override {
        const auto given = static_cast<unsigned>(std::min(in.size(), kMostAtOnce));
        const auto room = static_cast<unsigned>(std::min(out.size(), kMostAtOnce));
        stream_.next_in = reinterpret_cast<char*>(const_cast<unsigned char*>(in.data()));
        stream_.avail_in = given;
        stream_.next_out = reinterpret_cast<char*>(out.data());
        stream_.avail_out = room;
        const int status = ::BZ2_bzDecompress(&stream_);
        Step step{given - stream_.avail_in, room - stream_.avail_out, status == BZ_STREAM_END, nullptr};
        if (status == BZ_MEM_ERROR) throw std::bad_alloc();
        if (status != BZ_OK && status != BZ_STREAM_END) step.damage = "bzip2 failed";
        return step;
    }

    bool begins_again(std::span<const unsigned char> next) override {
        if (next.size() < 3 || next[0] != 'B' || next[1] != 'Z' || next[2] != 'h') return false;
        ::BZ2_bzDecompressEnd(&stream_);
        begin();
        return true;
    }

    // A block holds 900,000 bytes, of which five can stand for a run of 259; it takes more than 12.
    std::uint64_t most_inflation() const override { return 900'000 / 5 * 259 / 12; }

private:
    void begin() {
        stream_ = {};
        constexpr int kSilent = 0, kFast = 0;
        if (::BZ2_bzDecompressInit(&stream_, kSilent, kFast) != BZ_OK) throw std::bad_alloc();
    }

    bz_stream stream_{};
};

}  // namespace

std::unique_ptr<Decompressor> make_inflater(Inflation format) {
    constexpr int kGzipOrZlib = 32;
    return std::make_unique<Inflater>(format == Inflation::raw ? -MAX_WBITS : MAX_WBITS + kGzipOrZlib);
}

std::unique_ptr<Decompressor> make_bunzip2() { return std::make_unique<Bunzip2>(); }

}  // namespace kontur
