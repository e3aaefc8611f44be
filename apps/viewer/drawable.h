// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur::viewer {

/// Takes out of a file's contours what the page cannot draw and a project does not keep: open lines, what a contour says of
/// its end, and weights. One sentence for each kind, without the structure's name. Where only open lines were drawn, no
/// contour is left.
std::vector<std::string> leave_out_undrawable(ContourSet& set);

/// Throws Error(unsupported) where none is left.
void check_is_drawable(const ContourSet& set);

}  // namespace kontur::viewer
