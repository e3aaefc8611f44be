// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/work.h"
#include "kontur/fit/prepare.h"
#include "kontur/function/implicit_function.h"

namespace kontur {

/// A click that moves the surface turns it about the drawn lines, so beyond them it would move the other way. But a click
/// "outside" asks for less of the object, nowhere for more. The guards are places on the surface that runs without clicks,
/// around such a click. An exterior click may bring none of them inside, an interior one none outside. None for clicks that
/// are on their side anyway.
std::vector<Bound> click_guards(const PreparedContours& contours, const ImplicitFunction& without_clicks, const Work& work);

}  // namespace kontur
