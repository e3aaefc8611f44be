// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/moving/moments.h"
#include "kontur/moving/moving_function.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/fill_rule.h"

namespace kontur {

/// A moment at which so much of the planes drawn at any moment was drawn stands for itself: what was left out there may not
/// have been there to be drawn.
inline constexpr double kWholeFraction = 2.0 / 3;

/// What was drawn at each moment of a moving object, and in which planes others were drawn.
struct DrawnMoments {
    Moments moments;
    std::vector<ContourSet> sets;             ///< at each moment
    std::vector<std::vector<Plane>> missing;  ///< of each moment: planes drawn at others alone
    std::vector<bool> is_whole;               ///< by kWholeFraction
};
DrawnMoments drawn_moments(const ContourSet& set, const Moments& moments);

/// Sections of the object at moments that are not whole, in the planes that were drawn at others: where a process in space
/// and time through all contours vanishes there. `whole` is the motion between whole moments, nullptr without any; the
/// process is what contours leave of it. How fast time runs beside space is what foretells best the contours of these
/// moments, each left out in turn. For each moment its contours; none at whole ones. The
/// same bytes for any number of threads.
std::vector<std::vector<Contour>> carried_sections(const ContourSet& set, const DrawnMoments& drawn,
                                                   const MovingFunction* whole, FillRule fill_rule, const Work& work = {});

}  // namespace kontur
