// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kontur {

/// Whether all of it is well-formed UTF-8.
bool is_utf8(std::string_view text) noexcept;

/// Throws Error(invalid_input) unless the text is UTF-8; `what` is its subject, such as "the structure's name". Files that
/// say they are in UTF-8 would not be.
void check_utf8(std::string_view text, std::string_view what);

/// The text with each control character, and each byte that is no UTF-8, as '?'. Names from files travel into messages of
/// one line, onto terminals and into JSON, whatever they claim to be.
std::string printable_utf8(std::string_view text);

/// The same, with all but its beginning left out when it has more bytes than that.
std::string shortened(std::string_view text, std::size_t most_bytes);

/// With small letters for the capitals of ASCII: extensions and keywords.
std::string lower_case(std::string_view text);

/// With small letters for capitals, those of Latin-1 with accents among them: by this, names are compared that people type.
std::string without_case(std::string_view text);

/// Of text in Latin-1, which is what files without a declared character set hold as a rule.
std::string latin1_to_utf8(std::string_view text);

}  // namespace kontur
