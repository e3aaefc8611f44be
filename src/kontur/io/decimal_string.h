// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

namespace kontur {

/// The numbers of a DICOM decimal string: values separated by '\', blanks around each allowed, independent of the locale.
/// Throws Error(corrupt_file) naming the first value (counted from 1) that is empty, no number or not finite.
/// An empty or blank string has no values.
std::vector<double> parse_decimal_string(std::string_view text);

}  // namespace kontur
