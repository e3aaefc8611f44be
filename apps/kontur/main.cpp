// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <new>

#include "command_line.h"
#include "interrupt.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

int fail(std::string_view sentence, int exit_code) {
    fmt::print(stderr, "kontur: error: {}\n", sentence);
    return exit_code;
}

int run(const Invocation& invocation) {
    const Interrupt interrupt;
    try {
        Console console(invocation.quiet, interrupt.token());
        invocation.command(console);
        // What was printed must have arrived: a full disk behind a redirected stdout is a failure like any other.
        if (std::fflush(stdout) != 0) throw Error(ErrorKind::io, "standard output cannot be written");
        return 0;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) return fail("interrupted; nothing was written", exit_code(error.kind()));
        return fail(error.what(), exit_code(error.kind()));
    } catch (const std::bad_alloc&) {
        return fail("not enough memory for this input", exit_code(ErrorKind::too_large));
    }
}

int main(int argc, char** argv) {
    const Invocation invocation = parse_command_line(argc, argv);
    if (invocation.command) return run(invocation);
    if (invocation.exit_code != 0) return fail(invocation.text, invocation.exit_code);
    fmt::print("{}", invocation.text);
    return 0;
}

}  // namespace
}  // namespace kontur::app

int main(int argc, char** argv) { return kontur::app::main(argc, argv); }
