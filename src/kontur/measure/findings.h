// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to measure/: what the two halves of check_contour_set share.

#include <string>
#include <vector>

#include "kontur/measure/contour_check.h"

namespace kontur {

/// "contour 3" for index 2.
std::string contour_name(std::size_t index);

/// What one contour shows by itself. True if the rest of the set may rely on it: finite, with a plane and 3 points on it.
bool check_one_contour(const Contour& contour, std::size_t index, const ContourCheckOptions& limits,
                       std::vector<Finding>& findings);

}  // namespace kontur
