// SPDX-License-Identifier: Apache-2.0
#include "result.h"

#include <cstddef>

/// Told how far a call is; not 0: it shall stop.
extern "C" __attribute__((import_module("kontur"), import_name("progress"))) int kontur_progress(const char* stage,
                                                                                                 std::size_t length,
                                                                                                 double fraction);

namespace kontur::wasm {
namespace {

std::string the_error;

}  // namespace

void note_error(std::string_view kind, std::string_view message) {
    using nlohmann::json;
    the_error = json{{"kind", kind}, {"message", message}}.dump(-1, ' ', false, json::error_handler_t::replace);
}

Work told_work() {
    const StopSource stop;
    return {.threads = 1,
            .callback =
                [stop](std::string_view stage, double fraction) {
                    if (kontur_progress(stage.data(), stage.size(), fraction) != 0) stop.request_stop();
                },
            .stop = stop.token()};
}

}  // namespace kontur::wasm

KONTUR_EXPORT(kontur_error)()->const char* { return kontur::wasm::the_error.c_str(); }
