// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/paths.h"

namespace kontur::test {

struct PythonResult {
    int exit_code = -1;
    std::string output;  ///< standard output and standard error together
};

/// Runs tests/support/SCRIPT with Debian's Python, which has NumPy, SciPy, nibabel and pydicom.
inline PythonResult run_python(const std::string& script, const std::vector<std::string>& arguments) {
    std::string command = python_program() + " '" + support_folder() + "/" + script + "'";
    for (const std::string& argument : arguments) command += " '" + argument + "'";
    std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) throw std::runtime_error("cannot run " + command);
    PythonResult result;
    std::array<char, 4096> buffer;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
        result.output.append(buffer.data(), count);
    const int status = ::pclose(pipe);
    if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
    return result;
}

}  // namespace kontur::test
