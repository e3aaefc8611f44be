// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/machine_memory.h"

#include <unistd.h>

#include <fstream>

namespace kontur {
namespace {

double pages_to_mb(long pages) { return static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6; }

}  // namespace

double machine_memory_mb() { return pages_to_mb(::sysconf(_SC_PHYS_PAGES)); }

double resident_memory_mb() {
    long all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return pages_to_mb(resident);
}

}  // namespace kontur
