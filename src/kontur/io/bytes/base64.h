// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace kontur {

/// RFC 4648. Internal to io.
std::string to_base64(std::span<const unsigned char> bytes);

/// At most `most_bytes` of what the text says, blanks passed over; one encoding may follow another behind its padding. Ends
/// at the first character that belongs to none.
std::string from_base64(std::string_view text, std::size_t most_bytes);

}  // namespace kontur
