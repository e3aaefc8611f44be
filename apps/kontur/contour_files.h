// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kontur/io/contours.h"

namespace kontur::app {

/// `read_contours` for a fit, which would refuse some of them, too, but knows no files. Throws Error(invalid_input) then,
/// naming the file, in which contours count from 1.
ReadContours read_contours_to_fit(const std::vector<std::filesystem::path>& paths, const ReadContoursOptions& options);

/// Throws Error(invalid_input), naming the file, where a contour by itself is to blame, as one with points off its plane.
void check_each_contour(const std::filesystem::path& file, const ContourSet& contours);

/// Says of all contours in which frame they were drawn.
void set_frame(ContourSet& contours, double frame);

/// Puts what a reader said before what the fit says of the same file, which does not repeat it.
void put_notes_first(const std::vector<std::string>& notes, std::vector<std::string>& warnings);

}  // namespace kontur::app
