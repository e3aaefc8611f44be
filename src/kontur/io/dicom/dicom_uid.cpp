// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_uid.h"

#include <array>
#include <cstdint>
#include <random>

namespace kontur {
namespace {

/// 128 bits, most significant first.
using Uuid = std::array<std::uint32_t, 4>;

Uuid random_uuid() {
    std::random_device device;
    Uuid uuid;
    for (std::uint32_t& word : uuid) word = device();
    uuid[1] = (uuid[1] & 0xFFFF0FFFu) | 0x00004000u;  // version 4
    uuid[2] = (uuid[2] & 0x3FFFFFFFu) | 0x80000000u;  // variant of RFC 4122
    return uuid;
}

/// Divides by 10 and returns the remainder.
std::uint32_t take_digit(Uuid& number) {
    std::uint64_t remainder = 0;
    for (std::uint32_t& word : number) {
        const std::uint64_t value = remainder << 32 | word;
        word = static_cast<std::uint32_t>(value / 10);
        remainder = value % 10;
    }
    return static_cast<std::uint32_t>(remainder);
}

}  // namespace

std::string new_uid() {
    Uuid number = random_uuid();
    std::string digits;
    while (number != Uuid{}) digits.insert(digits.begin(), static_cast<char>('0' + take_digit(number)));
    return "2.25." + digits;
}

}  // namespace kontur
