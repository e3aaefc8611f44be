// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/refine/movement.h"
#include "kontur/refine/refine.h"

namespace kontur {

/// Moves the surface to where the image shows the border, as far as that is believed, by one more solve. Verdict: used, or
/// astray.
RefinedFunction move_surface(const DrawnOnImage& drawn, const Drawing& drawing, const PreparedContours& prepared,
                             const FittedFunction& fitted, const Beliefs& beliefs, const RefineOptions& options,
                             const Work& work);

}  // namespace kontur
