// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/moving_function.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/checks.h"

namespace kontur {

MovingFunction::MovingFunction(TimeCourse course, std::vector<ImplicitFunction> functions)
    : course_(std::move(course)), functions_(std::move(functions)) {
    check_same_count("functions", functions_.size(), "moments", course_.times().size());
}

double MovingFunction::value(const Vec3& point_mm, double time) const {
    double value = 0;
    values({&point_mm, 1}, time, {&value, 1}, {.threads = 1});
    return value;
}

void MovingFunction::values(std::span<const Vec3> points_mm, double time, std::span<double> out, const Work& work) const {
    check_same_count("values", out.size(), "points", points_mm.size());
    const TimeCourse::Place place = course_.place_of(time);
    if (place.before == place.after) return functions_[place.before].values(points_mm, out, work);
    std::vector<std::vector<double>> at(functions_.size(), std::vector<double>(points_mm.size()));
    for (std::size_t k = 0; k < functions_.size(); ++k) functions_[k].values(points_mm, at[k], work);
    std::vector<double> values(functions_.size());
    for (std::size_t n = 0; n < points_mm.size(); ++n) {
        for (std::size_t k = 0; k < values.size(); ++k) values[k] = at[k][n];
        out[n] = course_.value(place, values);
    }
}

std::vector<double> MovingFunction::changes(const std::vector<Vec3>& points_mm, double time, const Work& work) const {
    const TimeCourse::Place place = course_.place_of(time);
    std::vector<double> before(points_mm.size()), after = before;
    if (place.before == place.after) return before;
    functions_[place.before].values(points_mm, before, work);
    functions_[place.after].values(points_mm, after, work);
    for (std::size_t n = 0; n < before.size(); ++n) after[n] = std::abs(after[n] - before[n]);
    return after;
}

}  // namespace kontur
