// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kontur::app {

/// Rules (docs/derive.md), one in each line; what follows a '#' out of quotes is a comment. Throws Error(io), and
/// Error(invalid_input) for a file without a rule or larger than a MiB.
std::vector<std::string> read_rules_file(const std::filesystem::path& path);

}  // namespace kontur::app
