// SPDX-License-Identifier: Apache-2.0
#include "support/paths.h"

namespace kontur::test {

std::string default_data_folder() { return KONTUR_TEST_DATA_DEFAULT; }
std::string python_program() { return KONTUR_TEST_PYTHON; }
std::string support_folder() { return KONTUR_TEST_SUPPORT; }

}  // namespace kontur::test
