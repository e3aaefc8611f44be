// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "kontur/base/sha256_block.h"

namespace kontur {

/// SHA-256 of bytes that come in pieces. Source: NIST FIPS 180-4.
class Sha256 {
public:
    void update(std::span<const std::byte> bytes);
    /// 64 hexadecimal digits of what came so far.
    std::string hex() const;

private:
    Sha256State state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::byte, 64> pending_{};
    std::uint64_t byte_count_ = 0;
};

}  // namespace kontur
