// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

// What a name of a structure may hold. Control characters break lists, and text-direction marks let one name pass for
// another.

namespace kontur::viewer {

/// Throws Error(invalid_input) that names the first such character, as U+202E. The text is UTF-8.
void check_name(std::string_view name);

/// The name without them.
std::string plain_text(std::string_view name);

}  // namespace kontur::viewer
