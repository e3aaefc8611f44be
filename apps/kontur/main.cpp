// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

#include "command_line.h"
#include "commands.h"
#include "interrupt.h"
#include "kontur/base/error.h"
#include "usage_sentence.h"
#include "viewer/files/imports.h"

namespace kontur::app {
namespace {

int fail(std::string_view sentence, int exit_code) {
    print_stderr(fmt::format("kontur: error: {}\n", sentence));
    return exit_code;
}

/// A stream that was closed is one that cannot be written; else the first file opened would take its place, and its words.
void fill_closed_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0) open("/dev/null", O_RDONLY);  // takes the lowest number that is free
}

void run_command(const Invocation& invocation) {
    const Interrupt interrupt;
    Console console(invocation.quiet, interrupt.token(), invocation.options);
    if (invocation.archive) fetch_addresses(*invocation.archive, console);
    invocation.command(console);
}

int run(const Invocation& invocation) {
    try {
        if (invocation.command) run_command(invocation);
        else std::fwrite(invocation.text.data(), 1, invocation.text.size(), stdout);
        flush_stdout();
        return 0;
    } catch (const Error& error) {
        const bool cancelled = error.kind() == ErrorKind::cancelled;
        return fail(cancelled ? "interrupted; nothing was written" : with_typed_options(error.what(), invocation.options),
                    exit_code(error.kind()));
    } catch (const EndedEarly& ended) {
        return fail(ended.what(), ended.exit_code);
    } catch (const std::bad_alloc&) {
        return fail("not enough memory for this input", exit_code(ErrorKind::too_large));
    } catch (const std::exception& error) {
        return fail(fmt::format("unexpected: {}", error.what()), kInternalExitCode);
    }
}

int main(int argc, char** argv) {
    fill_closed_streams();
    if (argc > 1 && std::string_view(argv[1]) == viewer::kImportWorker) return viewer::import_worker(argc, argv);
    // A file beyond the user's limit, a reader of stdout that has gone: told as what cannot be written, and nothing is left.
    for (const int signal : kIgnoredSignals) std::signal(signal, SIG_IGN);
    const Invocation invocation = parse_command_line(argc, argv);
    return invocation.exit_code != 0 ? fail(invocation.text, invocation.exit_code) : run(invocation);
}

}  // namespace
}  // namespace kontur::app

int main(int argc, char** argv) { return kontur::app::main(argc, argv); }
