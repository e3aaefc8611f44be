// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kontur {

/// The numbers of a DICOM decimal string: values separated by '\', blanks around each allowed, independent of the locale.
/// Throws Error(corrupt_file) naming the first value (counted from 1) that is empty, no number or not finite.
/// An empty or blank string has no values.
std::vector<double> parse_decimal_string(std::string_view text);

/// A finite number in at most 16 characters, as DICOM wants it: the shortest text that reads back as the same double where
/// that fits, else as many digits as fit (for coordinates below 10 m an error under 1e-9 mm).
std::string to_decimal_string(double value);

}  // namespace kontur
