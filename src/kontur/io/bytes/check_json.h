// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

/// Throws Error(corrupt_file), with the place, unless the text is JSON whose numbers are doubles and in whose objects no key
/// stands twice. For programs that parse JSON by themselves: parsers keep the last of two such values, or the first, without
/// a word. Not part of the public API.
void check_json(std::string_view text);

}  // namespace kontur
