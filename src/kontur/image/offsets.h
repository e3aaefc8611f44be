// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/sampling/moving_point.h"

namespace kontur {

/// How the offsets of points of the surface go together before the image is looked at: u ~ GP(0, c sd sd'), c Matern's
/// covariance of smoothness 3/2, less where the normals differ, so that the two sides of a sheet move apart.
struct OffsetPrior {
    double length_mm = 1;

    double correlation(const MovingPoint& a, const MovingPoint& b) const;
    double covariance(const MovingPoint& a, const MovingPoint& b) const {
        return a.prior_mm * b.prior_mm * correlation(a, b);
    }
};

/// What the image says of the points, on the offsets -most .. most in steps.
struct OffsetEvidence {
    double step_mm = 1;
    int most = 0;
    std::vector<std::vector<double>> log_likelihood;  ///< one row of 2 most + 1 for each point
    std::vector<double> image_sd_mm;                  ///< how wrong the image is known to be at each; empty: not known
};

struct Offsets {
    std::vector<double> mean_mm, sd_mm;
    std::vector<double> weights;  ///< of the prior covariances with the points: the mean offset anywhere else
};

/// The posterior by three sweeps of expectation propagation (Minka 2001; Rasmussen & Williams 2006, 3.6), all points at
/// once. What a point shows counts as Gaussian with the moments that it leaves; a flat line of intensities says nothing. The
/// image's errors are shared by neighbours: together they count no more than one seen with `image_sd_mm`.
Offsets find_offsets(std::span<const MovingPoint> points, const OffsetPrior& prior, const OffsetEvidence& evidence,
                     const Work& work = {});

/// The mean offset of another point.
double offset_at(const MovingPoint& point, std::span<const MovingPoint> points, const OffsetPrior& prior,
                 const Offsets& offsets);

}  // namespace kontur
