// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

namespace kontur {

/// Of formats that store numbers so on every machine.
inline constexpr bool kBigEndian = true;

/// A number as it stands in a file. Internal to io, as is the rest of this file.
template <typename Stored>
Stored load(const unsigned char* bytes, bool big_endian) {
    std::array<unsigned char, sizeof(Stored)> copy;
    std::copy_n(bytes, sizeof(Stored), copy.begin());
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(copy.begin(), copy.end());
    return std::bit_cast<Stored>(copy);
}

template <typename Stored>
void store(Stored value, bool big_endian, unsigned char* bytes) {
    auto stored = std::bit_cast<std::array<unsigned char, sizeof(Stored)>>(value);
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(stored.begin(), stored.end());
    std::copy(stored.begin(), stored.end(), bytes);
}

}  // namespace kontur
