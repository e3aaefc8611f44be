// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "archive_words.h"
#include "console.h"

namespace kontur::app {

/// Wrong usage of the command line is no kontur::Error; sysexits' EX_USAGE.
constexpr int kUsageExitCode = 64;
/// Some cases of a batch failed; the others were done.
constexpr int kCasesFailedExitCode = 1;
/// An exception that should not have come this far; EX_SOFTWARE.
constexpr int kInternalExitCode = 70;

/// What the words on the command line ask for: either a text to show (help, version, a usage error) or a command to run.
struct Invocation {
    std::string text;                       ///< shown on stdout when exit_code is 0, else the sentence of a usage error
    int exit_code = 0;                      ///< of `text`
    bool quiet = false;                     ///< for the Console
    std::vector<std::string> options;       ///< the long ones of the command
    std::function<void(Console&)> command;  ///< empty: show `text` instead
    std::shared_ptr<const ArchiveWords> archive;  ///< words of the command that may be addresses; nullptr: none
    std::function<void()> check;                  ///< of segment: check_words(); else empty
};

Invocation parse_command_line(int argc, const char* const* argv);

/// An option without its dashes.
struct OptionName {
    std::string name;
    bool is_flag = false;  ///< it takes no value
};

/// All that `segment` has.
std::vector<OptionName> options_of_segment();

}  // namespace kontur::app
