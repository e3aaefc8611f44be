// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/whole_motion.h"

#include <set>

namespace kontur {

WholeMotion::WholeMotion(const TimeCourse& course, const std::vector<std::optional<ImplicitFunction>>& functions,
                         const std::vector<double>& weights) {
    double below = 0;
    for (const double level : std::set<double>(weights.begin(), weights.end())) {
        if (level == 0) continue;
        std::vector<double> times;
        std::vector<ImplicitFunction> reaching;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            if (weights[k] < level) continue;
            times.push_back(course.times()[k]);
            reaching.push_back(functions[k].value());
        }
        levels_.push_back({level - below, {TimeCourse(std::move(times), course.cycle()), std::move(reaching)}});
        below = level;
    }
    without_ = 1 - below;
}

void WholeMotion::lay_over(std::span<const Vec3> points_mm, double time, std::span<double> values, const Work& work) const {
    for (double& value : values) value *= without_;
    std::vector<double> of_level(points_mm.size());
    for (const Level& level : levels_) {
        level.motion.values(points_mm, time, of_level, work);
        for (std::size_t n = 0; n < of_level.size(); ++n) values[n] += level.share * of_level[n];
    }
}

}  // namespace kontur
