// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "files.h"
#include "kontur/measure/compare.h"

// One struct for each command, with its words and options and their defaults, and the function that runs it: it reads, calls
// the library and writes. What it writes appears whole or not at all. All of them throw kontur::Error.

namespace kontur::app {

/// How alike two masks on one grid are.
struct CompareCommand {
    std::filesystem::path a, b;
    std::optional<std::int64_t> label;
    ReadImageOptions read;
    CompareOptions options;
    bool json = false;
};
void run(const CompareCommand& command, Console& console);

/// What files are, and what is wrong with them.
struct InspectCommand {
    std::vector<std::filesystem::path> files;
    ReadImageOptions read;
    bool json = false;
};
void run(const InspectCommand& command, Console& console);

/// The same content in another format.
struct ConvertCommand {
    ImageInput input;
    std::optional<std::string> roi;
    std::filesystem::path output;
};
void run(const ConvertCommand& command, Console& console);

}  // namespace kontur::app
