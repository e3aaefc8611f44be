// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace kontur {

/// SHA-256 (NIST FIPS 180-4) in plain C++, at about a seventh of OpenSSL's speed: for builds without it.
class PlainSha256 {
public:
    void update(std::span<const std::byte> bytes);
    /// 64 hexadecimal digits of what came so far.
    std::string hex() const;

private:
    static constexpr std::size_t kBlockBytes = 64;

    void take_block();

    std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::byte, kBlockBytes> block_{};
    std::size_t filled_ = 0;   ///< bytes of the block
    std::uint64_t bytes_ = 0;  ///< so far
};

}  // namespace kontur
