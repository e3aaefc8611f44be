// SPDX-License-Identifier: Apache-2.0
// What libFuzzer calls. KONTUR_FUZZ_TARGET names the target; one program for all keeps linking short.
#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.h"

namespace {

const kontur::fuzz::Target* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    const char* name = std::getenv("KONTUR_FUZZ_TARGET");
    chosen = name ? kontur::fuzz::find_target(name) : nullptr;
    if (chosen) return 0;
    std::fprintf(stderr, "KONTUR_FUZZ_TARGET must be one of:");
    for (const auto& target : kontur::fuzz::targets())
        std::fprintf(stderr, " %.*s", static_cast<int>(target.name.size()), target.name.data());
    std::fprintf(stderr, "\n");
    std::exit(64);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    kontur::fuzz::run(*chosen, {data, size});
    return 0;
}
