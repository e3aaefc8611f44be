// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/machine_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

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

double peak_memory_mb() {
    // The highest mark of this program alone; getrusage's includes that of the program that started it.
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) * 1024 / 1e6;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;  // Linux counts kibibytes
}

}  // namespace kontur
