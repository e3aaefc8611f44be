// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: the user's names in DICOM files, which have room for 64 characters of each and a meaning of their own for
// the backslash.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kontur::dcmtk {

/// Characters of free text, VR ST (PS3.5 table 6.2-1).
inline constexpr std::size_t kMostTextCharacters = 1024;

/// `one_value` of the text. Adds a sentence to `notes` where that is another text; `what` is its subject, such as "the name
/// of ROI 2".
std::string noted_value(std::string_view text, std::size_t max_characters, const std::string& what,
                        std::vector<std::string>& notes);

/// The same for free text, which may have backslashes and several lines, ended in DICOM's way. Throws Error(invalid_input)
/// for no UTF-8.
std::string noted_text(std::string_view text, std::size_t max_characters, const std::string& what,
                       std::vector<std::string>& notes);

/// Names as they are stored, of which two are equal only if they were before: what was cut to the same characters gets a
/// number in brackets. `what` is what has the names, such as "ROI"; it is counted from 1. Throws
/// Error(invalid_input) for a name that is no UTF-8.
std::vector<std::string> stored_names(const std::vector<std::string>& names, const std::string& what,
                                      std::vector<std::string>& notes);

}  // namespace kontur::dcmtk
