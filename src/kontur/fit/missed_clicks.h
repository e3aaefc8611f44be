// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/function/implicit_function.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// The points that did not get their side, one sentence each, and one on those of the set's surface points that the surface
/// passes farther from than `reach_mm`.
std::vector<std::string> missed_clicks(const ContourSet& set, const ImplicitFunction& function, double reach_mm);

}  // namespace kontur
