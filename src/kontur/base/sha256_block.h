// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kontur {

using Sha256State = std::array<std::uint32_t, 8>;

/// What a block of 64 bytes makes of the state (FIPS 180-4, 6.2.2), by the processor's own instructions where it has them.
void compress_sha256(Sha256State& state, const std::byte* block);

/// The same in plain arithmetic.
void compress_sha256_plainly(Sha256State& state, const std::byte* block);

}  // namespace kontur
