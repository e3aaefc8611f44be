// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/drawing/found_side.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/crossings.h"
#include "kontur/shape/fill_rule.h"
#include "kontur/shape/near_lines.h"

namespace kontur {

/// What was drawn, without repeated points and with its holes known, and what all stages ask of it, found once.
struct Drawing {
    /// Leaves out repeated points, checks, leaves out contours that enclose nothing or repeat others (check_and_tidy, which
    /// throws), finds holes (apply_fill_rule), and makes lines that were drawn twice one (make_one_line); indices are those
    /// after all this.
    Drawing(ContourSet drawn, FillRule rule = FillRule::even_odd);

    ContourSet contours;                ///< those of very many points thinned (thin_vast)
    std::size_t points_drawn = 0;       ///< of contours, with those that were left out by that
    std::vector<std::size_t> numbers;   ///< for each contour its index in what was drawn
    ContourSet tidied;                  ///< the same without spikes, and with no more points than the fit needs
    Ball3 ball;                         ///< the smallest one around the tidied contours and single points, mm
    std::vector<Crossing> crossings;    ///< of contours of different planes
    std::vector<NearLines> near_lines;  ///< of one plane (FillChanges), with indices in what was drawn
    std::vector<FoundSide> sides{};     ///< where they have been asked for (read_drawing); `tidied` has them
    std::vector<std::string> notes;     ///< what was changed or is contradictory, one sentence each

    /// What the method's lengths are fractions of, so that results turn and scale with the contours.
    double diameter_mm() const { return ball.diameter(); }
};

}  // namespace kontur
