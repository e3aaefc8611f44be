// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/moving/time_course.h"

namespace kontur {

/// f(x, t) of an object that moves: functions at some moments, and between them how their values run (TimeCourse). Positive
/// inside. Continuous with a continuous rate of change in t. Between two moments it lies between their values everywhere:
/// what is inside at both is inside all the while. Cheap to copy, safe to read from any thread.
class MovingFunction {
public:
    /// Throws Error(invalid_input) unless there is one function for each moment.
    MovingFunction(TimeCourse course, std::vector<ImplicitFunction> functions);

    const TimeCourse& course() const { return course_; }
    const std::vector<ImplicitFunction>& functions() const { return functions_; }

    double value(const Vec3& point_mm, double time) const;
    /// out[i] = value(points[i], time), in bulk. Throws Error(invalid_input) unless there is one place for each point.
    void values(std::span<const Vec3> points_mm, double time, std::span<double> out, const Work& work = {}) const;
    /// How far each value is at the moment before from that at the moment after; 0 at a moment.
    std::vector<double> changes(const std::vector<Vec3>& points_mm, double time, const Work& work = {}) const;

private:
    TimeCourse course_;
    std::vector<ImplicitFunction> functions_;
};

}  // namespace kontur
