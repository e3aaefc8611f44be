// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/moving/moving_function.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Masks of a moving object at all times. What is inside at two moments, or outside, stays so between them; so f is computed
/// where the moments' masks differ, and only there. Safe to read from several threads.
class MaskCourse {
public:
    /// `masks` are those of the function's moments, of one grid. Throws Error(invalid_input) unless there is one for each.
    MaskCourse(const MovingFunction& function, std::vector<Mask> masks, const Work& work = {});

    Mask at(double time) const;

    const TimeCourse& course() const { return course_; }
    /// Of voxels that are inside at one of two moments alone, and at some moments alone.
    double differing_ml(std::size_t one, std::size_t other) const;
    double differing_ml() const;

private:
    TimeCourse course_;
    std::vector<Mask> masks_;
    std::vector<std::size_t> voxels_;  ///< in which moments differ
    std::vector<double> values_;       ///< of each of them f at all moments
};

/// Millilitres of the voxels inside.
double volume_ml(const Mask& mask);

}  // namespace kontur
