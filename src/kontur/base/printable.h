// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kontur {

/// Whether all of it is well-formed UTF-8.
bool is_utf8(std::string_view text) noexcept;

/// The text with each control character, and each byte that is no UTF-8, as '?'. Names from files travel into messages of
/// one line, onto terminals and into JSON, whatever they claim to be.
std::string printable_utf8(std::string_view text);

/// The same, with all but its beginning left out when it has more bytes than that.
std::string shortened(std::string_view text, std::size_t most_bytes);

}  // namespace kontur
