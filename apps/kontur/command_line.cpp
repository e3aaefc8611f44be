// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "kontur/base/error.h"

namespace kontur::app {
namespace {

std::string footer() {
    const auto code = [](ErrorKind kind) { return exit_code(kind); };
    return fmt::format(
        "Exit codes: 0 done, {} wrong usage, {} invalid input, {} corrupt file, {} unsupported, {} no unique solution,\n"
        "{} read or write failed, {} too large, {} interrupted (docs/command-line.md).\n"
        "Lengths are mm, volumes ml, coordinates the patient frame LPS. Research software, not a medical device.",
        kUsageExitCode, code(ErrorKind::invalid_input), code(ErrorKind::corrupt_file), code(ErrorKind::unsupported),
        code(ErrorKind::singular_system), code(ErrorKind::io), code(ErrorKind::too_large), code(ErrorKind::cancelled));
}

}  // namespace

Invocation parse_command_line(int argc, const char* const* argv) {
    Invocation invocation;
    CLI::App app("kontur: smooth 3D organs from a few hand-drawn contours", "kontur");
    app.set_version_flag("--version", "kontur " KONTUR_VERSION, "Print the version");
    app.footer(footer());
    app.require_subcommand(0, 1);

    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        const auto parsed = app.get_subcommands();
        invocation.text = parsed.empty() ? app.help() : parsed.front()->help();
        return invocation;
    } catch (const CLI::CallForVersion& version) {
        invocation.text = std::string(version.what()) + "\n";
        return invocation;
    } catch (const CLI::ParseError& error) {
        invocation.text = error.what();
        invocation.exit_code = kUsageExitCode;
        return invocation;
    }
    if (!invocation.command) invocation.text = app.help();
    return invocation;
}

}  // namespace kontur::app
