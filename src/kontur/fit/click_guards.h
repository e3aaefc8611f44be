// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/work.h"
#include "kontur/fit/prepare.h"
#include "kontur/function/implicit_function.h"

namespace kontur {

/// A click that moves the surface turns it about the drawn lines: beyond them it would move the other way. Who clicks
/// "outside" asks for less of the object, nowhere for more. So places of the surface around such a click, as it runs without
/// clicks, are not to come inside by an exterior one, nor outside by an interior one. None for clicks that have their side
/// without.
std::vector<Bound> click_guards(const PreparedContours& contours, const ImplicitFunction& without_clicks, const Work& work);

}  // namespace kontur
