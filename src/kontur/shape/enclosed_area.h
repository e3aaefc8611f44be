// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/predicates.h"

namespace kontur {

/// What one line encloses by the even-odd rule, mm2. The signed area of a line that crosses itself is the difference of its
/// lobes.
double enclosed_area(const Polygon2& line);

}  // namespace kontur
