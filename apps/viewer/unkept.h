// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur::viewer {

/// Takes out of a file's contours what a project does not keep: what a contour says of its end, and weights. One sentence
/// for each kind, without the structure's name.
std::vector<std::string> leave_out_unkept(ContourSet& set);

}  // namespace kontur::viewer
