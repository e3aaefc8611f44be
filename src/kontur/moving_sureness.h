// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/work.h"
#include "kontur/moving/moving_function.h"
#include "kontur/sureness/surface_evidence.h"
#include "kontur/volume_curve.h"

namespace kontur {

/// How sure a moving surface is, with what is known of each moment's, for any number of times.
class MovingSureness {
public:
    MovingSureness(TimeCourse course, const std::vector<DrawnMoment>& moments, const Work& work = {});

    /// Half the width in mm of the band in which 90 % of the true surface lies at a time, at points on or near the surface
    /// of that time. At a moment it is that of its surface (surface_uncertainty.h), between two of them in between. It is
    /// wider by how far the surface moves there from one to the other (`changes_mm`, of MovingFunction or MeshCourse), and
    /// by how long that takes. Sections that were carried count as drawn. Empty where a moment has too few planes to tell.
    std::vector<double> half_widths_mm(const std::vector<Vec3>& points, const std::vector<double>& changes_mm, double time,
                                       const Work& work = {}) const;

private:
    TimeCourse course_;
    std::vector<SurfaceEvidence> moments_;
};

/// The same at one time; for more of them MovingSureness keeps what they share.
std::vector<double> half_widths_mm(const MovingFunction& function, const std::vector<DrawnMoment>& moments,
                                   const std::vector<Vec3>& points, double time, const Work& work = {});

}  // namespace kontur
