// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/moving/moving_function.h"

namespace kontur {

/// The motion between moments that stand for themselves, each by a weight from 0 to 1: the mean, over all levels from 0 to
/// 1, of the motions between the moments whose weight reaches the level. So it changes with each weight without a step, that
/// of a moment that comes in and that of one that becomes whole. Cheap to copy, safe to read from any thread.
class WholeMotion {
public:
    /// `functions` are those of the course's moments; of a weight of 0 there is none.
    WholeMotion(const TimeCourse& course, const std::vector<std::optional<ImplicitFunction>>& functions,
                const std::vector<double>& weights);

    /// Puts the values into those given, which stay where no weight reaches a level.
    void lay_over(std::span<const Vec3> points_mm, double time, std::span<double> values, const Work& work = {}) const;

private:
    struct Level {
        double share;  ///< of all levels
        MovingFunction motion;
    };
    std::vector<Level> levels_;
    double without_ = 1;  ///< share of levels that no weight reaches
};

}  // namespace kontur
