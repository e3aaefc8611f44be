// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/sha256_block.h"

#include <bit>

#if defined(__x86_64__) && defined(__GNUC__)
#define KONTUR_HAS_SHA_INTRINSICS 1
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace kontur {
namespace {

/// Fractions of the cube roots of the first 64 primes.
alignas(16) constexpr std::array<std::uint32_t, 64> kRoundConstants{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5, 0xd807aa98, 0x12835b01,
    0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc,
    0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da, 0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147,
    0x06ca6351, 0x14292967, 0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070, 0x19a4c116, 0x1e376c08,
    0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3, 0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208,
    0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::uint32_t big_endian(const std::byte* bytes) {
    std::uint32_t value = 0;
    for (int n = 0; n < 4; ++n) value = value << 8 | std::to_integer<std::uint32_t>(bytes[n]);
    return value;
}

#ifdef KONTUR_HAS_SHA_INTRINSICS
bool has_sha_instructions() {
    unsigned a = 0, b = 0, c = 0, d = 0;
    return __builtin_cpu_supports("sse4.1") && __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b & bit_SHA) != 0;
}

/// Four rounds at a time; a register's first word is its lowest.
__attribute__((target("sha,sse4.1"))) void compress_by_instructions(Sha256State& state, const std::byte* block) {
    const auto word = [&](int n) { return static_cast<int>(state[static_cast<std::size_t>(n)]); };
    const __m128i abef_before = _mm_set_epi32(word(0), word(1), word(4), word(5));
    const __m128i cdgh_before = _mm_set_epi32(word(2), word(3), word(6), word(7));
    const __m128i big_endian_words = _mm_set_epi8(12, 13, 14, 15, 8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3);
    __m128i abef = abef_before, cdgh = cdgh_before;
    __m128i w[4];  // the last sixteen words of the message's schedule
    for (int round = 0; round < 64; round += 4) {
        const int n = round / 4 % 4;
        if (round < 16) {
            w[n] = _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(block + 4 * round)), big_endian_words);
        } else {
            const __m128i last = w[(n + 3) % 4];
            const __m128i sum =
                _mm_add_epi32(_mm_sha256msg1_epu32(w[n], w[(n + 1) % 4]), _mm_alignr_epi8(last, w[(n + 2) % 4], 4));
            w[n] = _mm_sha256msg2_epu32(sum, last);
        }
        const __m128i constants =
            _mm_load_si128(reinterpret_cast<const __m128i*>(&kRoundConstants[static_cast<std::size_t>(round)]));
        const __m128i added = _mm_add_epi32(w[n], constants);
        cdgh = _mm_sha256rnds2_epu32(cdgh, abef, added);
        abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(added, 0x0E));
    }
    alignas(16) Sha256State out;
    _mm_store_si128(reinterpret_cast<__m128i*>(&out[0]), _mm_add_epi32(abef, abef_before));
    _mm_store_si128(reinterpret_cast<__m128i*>(&out[4]), _mm_add_epi32(cdgh, cdgh_before));
    state = {out[3], out[2], out[7], out[6], out[1], out[0], out[5], out[4]};
}
#endif

}  // namespace

void compress_sha256_plainly(Sha256State& state, const std::byte* block) {
    std::array<std::uint32_t, 64> w;
    for (std::size_t t = 0; t < 16; ++t) w[t] = big_endian(block + 4 * t);
    for (std::size_t t = 16; t < 64; ++t) {
        const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
        const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
        w[t] = w[t - 16] + s0 + w[t - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = state;
    for (std::size_t t = 0; t < 64; ++t) {
        const std::uint32_t sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
        const std::uint32_t first = h + sum1 + ((e & f) ^ (~e & g)) + kRoundConstants[t] + w[t];
        const std::uint32_t sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
        const std::uint32_t second = sum0 + ((a & b) ^ (a & c) ^ (b & c));
        h = g, g = f, f = e, e = d + first;
        d = c, c = b, b = a, a = first + second;
    }
    const std::array<std::uint32_t, 8> added{a, b, c, d, e, f, g, h};
    for (std::size_t n = 0; n < 8; ++n) state[n] += added[n];
}

void compress_sha256(Sha256State& state, const std::byte* block) {
#ifdef KONTUR_HAS_SHA_INTRINSICS
    static const bool has = has_sha_instructions();
    if (has) return compress_by_instructions(state, block);
#endif
    compress_sha256_plainly(state, block);
}

}  // namespace kontur
