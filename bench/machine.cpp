// SPDX-License-Identifier: Apache-2.0
#include "machine.h"

#include <cblas.h>
#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

namespace kontur::bench {
namespace {

/// Name of the OpenBLAS kernels for this CPU; null to leave the choice to OpenBLAS.
const char* fitting_blas_core() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        return "SkylakeX";
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Zen";
#endif
    return nullptr;
}

/// What follows "KEY ... :" in a file such as /proc/cpuinfo; empty if nothing does.
std::string entry(const char* file, const std::string& key) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(key)) return line.substr(line.find_first_not_of(" \t", line.find(':') + 1));
    return {};
}

double megabytes(const std::string& key) {
    const std::string kilobytes = entry("/proc/self/status", key);
    return kilobytes.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(kilobytes) / 1024;
}

double load_average() {
    double load = std::numeric_limits<double>::quiet_NaN();
    return getloadavg(&load, 1) == 1 ? load : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void restart_with_fitting_blas(char** arguments) {
    const char* core = fitting_blas_core();
    if (!core || std::getenv("OPENBLAS_CORETYPE") || setenv("OPENBLAS_CORETYPE", core, 1) != 0) return;
    execv("/proc/self/exe", arguments);  // returns only where it failed; then the results name the kernels that ran
}

nlohmann::ordered_json describe_machine() {
    return {
        {"cpu", entry("/proc/cpuinfo", "model name")},
        {"cores", std::thread::hardware_concurrency()},
        {"load_before", load_average()},
        {"compiler", __VERSION__},
        {"build_type", KONTUR_BUILD_TYPE},
        {"blas", openblas_get_config()},
        {"blas_kernels", openblas_get_corename()},
    };
}

PeakMemory::PeakMemory() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5;  // sets the peak back to the present size
    before_mb_ = megabytes("VmRSS");
}

double PeakMemory::added_mb() const { return megabytes("VmHWM") - before_mb_; }

}  // namespace kontur::bench
