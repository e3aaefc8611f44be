// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/plain_sha256.h"

#include <algorithm>
#include <bit>

namespace kontur {
namespace {

/// Section 4.2.2: the first 32 bits behind the point of the cube roots of the first 64 primes.
constexpr std::array<std::uint32_t, 64> kRounds{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5, 0xd807aa98, 0x12835b01,
    0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc,
    0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da, 0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147,
    0x06ca6351, 0x14292967, 0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070, 0x19a4c116, 0x1e376c08,
    0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3, 0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208,
    0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

/// Section 6.2.2, step 1. Words are big-endian.
std::array<std::uint32_t, 64> schedule(std::span<const std::byte, 64> block) {
    std::array<std::uint32_t, 64> words;
    for (std::size_t t = 0; t < 16; ++t) {
        words[t] = 0;
        for (std::size_t n = 0; n < 4; ++n) words[t] = words[t] << 8 | static_cast<std::uint32_t>(block[4 * t + n]);
    }
    for (std::size_t t = 16; t < 64; ++t) {
        const std::uint32_t early = words[t - 15], late = words[t - 2];
        words[t] = words[t - 16] + words[t - 7] + (std::rotr(early, 7) ^ std::rotr(early, 18) ^ early >> 3) +
                   (std::rotr(late, 17) ^ std::rotr(late, 19) ^ late >> 10);
    }
    return words;
}

}  // namespace

/// Section 6.2.2, steps 2 to 4.
void PlainSha256::take_block() {
    const std::array<std::uint32_t, 64> words = schedule(block_);
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t t = 0; t < 64; ++t) {
        const std::uint32_t choice = (e & f) ^ (~e & g), majority = (a & b) ^ (a & c) ^ (b & c);
        const std::uint32_t first =
            h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) + choice + kRounds[t] + words[t];
        const std::uint32_t second = (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + majority;
        h = g, g = f, f = e, e = d + first, d = c, c = b, b = a, a = first + second;
    }
    const std::array<std::uint32_t, 8> added{a, b, c, d, e, f, g, h};
    for (std::size_t n = 0; n < 8; ++n) state_[n] += added[n];
    filled_ = 0;
}

void PlainSha256::update(std::span<const std::byte> bytes) {
    bytes_ += bytes.size();
    while (!bytes.empty()) {
        const std::size_t count = std::min(bytes.size(), kBlockBytes - filled_);
        std::copy_n(bytes.begin(), count, block_.begin() + static_cast<std::ptrdiff_t>(filled_));
        filled_ += count;
        bytes = bytes.subspan(count);
        if (filled_ == kBlockBytes) take_block();
    }
}

/// Section 5.1.1: a bit that is set, zeros, and the number of bits in 8 bytes end the last block.
std::string PlainSha256::hex() const {
    PlainSha256 rest = *this;
    const std::uint64_t bits = 8 * bytes_;
    std::array<std::byte, 2 * kBlockBytes> padding{std::byte{0x80}};
    const std::size_t zeros_end = (filled_ < kBlockBytes - 8 ? kBlockBytes : 2 * kBlockBytes) - 8 - filled_;
    for (std::size_t n = 0; n < 8; ++n) padding[zeros_end + n] = static_cast<std::byte>(bits >> (56 - 8 * n));
    rest.update(std::span(padding).first(zeros_end + 8));
    std::string text;
    for (const std::uint32_t word : rest.state_)
        for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[word >> shift & 15];
    return text;
}

}  // namespace kontur
