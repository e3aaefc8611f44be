// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/sha256.h"

#include <algorithm>

namespace kontur {

void Sha256::update(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const std::size_t filled = byte_count_ % pending_.size();
        if (filled == 0 && bytes.size() >= pending_.size()) {
            compress_sha256(state_, bytes.data());
            byte_count_ += pending_.size();
            bytes = bytes.subspan(pending_.size());
            continue;
        }
        const std::size_t count = std::min(bytes.size(), pending_.size() - filled);
        std::copy_n(bytes.begin(), count, pending_.begin() + static_cast<std::ptrdiff_t>(filled));
        byte_count_ += count;
        bytes = bytes.subspan(count);
        if (filled + count == pending_.size()) compress_sha256(state_, pending_.data());
    }
}

std::string Sha256::hex() const {
    Sha256 padded = *this;
    const std::uint64_t bits = 8 * byte_count_;
    std::array<std::byte, 72> padding{std::byte{0x80}};
    const std::size_t zeros = (119 - byte_count_ % 64) % 64;  // up to 8 bytes before a block's end
    for (std::size_t n = 0; n < 8; ++n) padding[1 + zeros + n] = static_cast<std::byte>(bits >> (56 - 8 * n));
    padded.update(std::span(padding).first(1 + zeros + 8));
    std::string text;
    for (const std::uint32_t word : padded.state_)
        for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[word >> shift & 15];
    return text;
}

}  // namespace kontur
