// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kontur::test {

// Of this build. One source file knows them, so that all others are the same in every checkout and ccache finds them.
std::string default_data_folder();  ///< of the real data sets, where KONTUR_TEST_DATA is not set; may not exist
std::string python_program();       ///< Debian's Python, which has NumPy, SciPy, nibabel and pydicom
std::string support_folder();       ///< tests/support

}  // namespace kontur::test
