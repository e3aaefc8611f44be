// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kontur/io/contours.h"

namespace kontur::app {

/// `read_contours` for a fit, which would refuse some of them, too, but knows no files. Throws Error(invalid_input) then,
/// naming the file, in which contours count from 1.
ReadContours read_contours_to_fit(const std::vector<std::filesystem::path>& paths, const ReadContoursOptions& options);

}  // namespace kontur::app
