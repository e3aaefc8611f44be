// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kontur/moving/time_course.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// When contours of a moving object were drawn, in frames or in seconds.
struct Moments {
    bool in_seconds = false;
    TimeCourse course;                               ///< over the moments at which something was drawn, in order
    std::vector<std::vector<std::size_t>> contours;  ///< of the set, at each of them
};

/// The moments of contours in any order. Throws Error(invalid_input), naming the contour (counted from 1), where one has no
/// moment or another unit than the first, where a cycle is given in another unit, is not above 0, or where a contour lies
/// beyond it: frames are those of 1 up to before 1 + `cycle_frames`, times those of 0 up to before `cycle_s`.
Moments moments_of(const ContourSet& set);

/// The set with the contours of one moment, which nobody can tell from one that does not move.
ContourSet at_moment(const ContourSet& set, const std::vector<std::size_t>& contours);

}  // namespace kontur
