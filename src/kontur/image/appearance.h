// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/image/intensities.h"
#include "kontur/sampling/moving_point.h"

namespace kontur {

/// How the image looks across the drawn contours: for each of them histograms of the intensities at 17 offsets from the
/// surface. Neither an edge nor its sign is looked for; whatever the drawn border looks like is what the border looks like.
class Appearance {
public:
    /// Learns from points on contours. `scale` maps intensities; `step_mm` is from offset to offset.
    Appearance(const Intensities& image, const IntensityScale& scale, std::span<const MovingPoint> examples, double step_mm,
               const Work& work);

    /// For offsets -most .. most, in steps, of the surface from the point along its normal: the logarithm of the probability
    /// of the intensities around the point, up to a constant. Every offset is judged by the same intensities; what lies
    /// outside of the image says nothing. The examples nearby teach it, those most that face the same way.
    std::vector<double> log_likelihood(const MovingPoint& point, int most) const;

    static constexpr int kHalf = 8;  ///< offsets on each side that describe the border
    static constexpr int kOffsets = 2 * kHalf + 1;
    static constexpr int kBins = 20;  ///< of intensity
    using Histograms = std::array<float, kOffsets * kBins>;

private:
    Histograms local(const MovingPoint& point) const;

    const Intensities& image_;
    const IntensityScale& scale_;
    double step_mm_;
    std::vector<MovingPoint> examples_;
    std::vector<Histograms> histograms_;  ///< one for each example
    Histograms mean_;                     ///< over all of them, each offset's sum 1
};

/// Intensities read at points of the surface, along their normals at every offset of `Appearance`.
std::vector<double> intensities_across(const Intensities& image, std::span<const MovingPoint> points, double step_mm,
                                       const Work& work);

}  // namespace kontur
