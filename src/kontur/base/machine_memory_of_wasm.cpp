// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/machine_memory.h"

namespace kontur {

/// A memory of WebAssembly has 32-bit addresses and grows; it never shrinks.
double machine_memory_mb() { return 4294.967296; }

double resident_memory_mb() {
    constexpr double kPageMb = 65536 / 1e6;
    return static_cast<double>(__builtin_wasm_memory_size(0)) * kPageMb;
}

double peak_memory_mb() { return resident_memory_mb(); }

}  // namespace kontur
