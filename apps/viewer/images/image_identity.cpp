// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/image_identity.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>

namespace kontur::viewer {
namespace {

/// FNV-1a over 64-bit words instead of bytes, each mixed in by a rotation too: a volume takes milliseconds.
class Hash {
public:
    void add(const void* bytes, std::size_t count) {
        const auto* at = static_cast<const unsigned char*>(bytes);
        for (; count >= 8; at += 8, count -= 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, at, 8);
            add(word);
        }
        std::uint64_t rest = 0;
        std::memcpy(&rest, at, count);
        add(rest);
    }
    void add(std::uint64_t word) {
        state_ = (state_ ^ word) * 0x100000001b3u;
        state_ ^= state_ >> 29;
    }
    std::uint64_t value() const { return state_; }

private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

constexpr std::array kTypes{"uint8", "int16", "uint16", "int32", "float"};

}  // namespace

std::string fingerprint(const Image& image) {
    Hash hash;
    for (int axis = 0; axis < 4; ++axis) {
        const Vec3 column = axis < 3 ? image.grid.index_to_mm.column(axis) : image.grid.index_to_mm.translation;
        for (int i = 0; i < 3; ++i) hash.add(static_cast<std::uint64_t>(std::llround(column[i] * 1000)));
    }
    std::visit([&](const auto& samples) { hash.add(samples.data(), samples.size() * sizeof(samples[0])); }, image.samples);
    const Index3& n = image.grid.size;
    return fmt::format("{}x{}x{}-{}-{:016x}", n.i, n.j, n.k, kTypes[image.samples.index()], hash.value());
}

}  // namespace kontur::viewer
