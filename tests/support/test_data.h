// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "support/paths.h"

namespace kontur::test {

/// Folder of the real data sets: KONTUR_TEST_DATA if set, else beside the checkout. May not exist.
inline std::filesystem::path data_dir() {
    const char* set = std::getenv("KONTUR_TEST_DATA");
    return set && *set ? std::filesystem::path(set) : std::filesystem::path(default_data_folder());
}

}  // namespace kontur::test

/// Skips the test, saying which file is missing, unless the real data is there. Usage:
/// KONTUR_REQUIRE_DATA("06_mr/x.nii.gz");
#define KONTUR_REQUIRE_DATA(relative)                                                                   \
    do {                                                                                                \
        if (!std::filesystem::exists(kontur::test::data_dir() / (relative)))                            \
            GTEST_SKIP() << "real data not found: " << (kontur::test::data_dir() / (relative)).string() \
                         << " (set KONTUR_TEST_DATA)";                                                  \
    } while (false)
