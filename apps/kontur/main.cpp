// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <signal.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

#include "command_line.h"
#include "commands.h"
#include "interrupt.h"
#include "kontur/base/error.h"
#include "viewer/imports.h"

namespace kontur::app {
namespace {

int fail(std::string_view sentence, int exit_code) {
    fmt::print(stderr, "kontur: error: {}\n", sentence);
    return exit_code;
}

/// What was printed must have arrived: a full disk behind a redirected stdout is a failure like any other.
void flush_stdout() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw Error(ErrorKind::io, "standard output cannot be written");
}

void run_command(const Invocation& invocation) {
    const Interrupt interrupt;
    Console console(invocation.quiet, interrupt.token());
    invocation.command(console);
}

int run(const Invocation& invocation) {
    try {
        run_command(invocation);
        flush_stdout();
        return 0;
    } catch (const Error& error) {
        const bool cancelled = error.kind() == ErrorKind::cancelled;
        return fail(cancelled ? "interrupted; nothing was written" : error.what(), exit_code(error.kind()));
    } catch (const EndedEarly& ended) {
        return fail(ended.what(), ended.exit_code);
    } catch (const std::bad_alloc&) {
        return fail("not enough memory for this input", exit_code(ErrorKind::too_large));
    } catch (const std::exception& error) {
        return fail(fmt::format("unexpected: {}", error.what()), kInternalExitCode);
    }
}

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == viewer::kImportWorker) return viewer::import_worker(argc, argv);
    signal(SIGXFSZ, SIG_IGN);  // a file beyond the user's limit is then told as a disk that is full
    const Invocation invocation = parse_command_line(argc, argv);
    if (invocation.command) return run(invocation);
    if (invocation.exit_code != 0) return fail(invocation.text, invocation.exit_code);
    fmt::print("{}", invocation.text);
    return 0;
}

}  // namespace
}  // namespace kontur::app

int main(int argc, char** argv) { return kontur::app::main(argc, argv); }
