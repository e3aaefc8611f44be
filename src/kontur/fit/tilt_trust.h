// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "kontur/drawing/boundary_point.h"

namespace kontur {

/// How well the course of a line some distance away foretells its direction: the mean square angle between the line's own
/// direction at a place and the chord from that far behind the place to that far ahead of it.
class LineTurns {
public:
    /// `scale_mm` > 0 is the length over which a line has a direction.
    LineTurns(const std::vector<BoundaryPoint>& points, double scale_mm);

    /// Mean square angle, from 0 within the scale; beyond the longest chord that was found the last one.
    double square_at(double distance_mm) const;

private:
    static constexpr std::size_t kChords = 14;  // the longest is 90 times the scale, more than any contour has room for

    double scale_mm_;
    std::array<double, kChords> squares_{};
};

/// The tilt of the surface at a point of a contour is read from lines around it in other planes. It is as uncertain as the
/// surface is rough in between. The lines themselves tell that roughness, since they run along the same surface. Of the tilt
/// t that a fit shows, the share that counts is
///
///     (V - e^2(h)) / V,   at least 0
///
/// the best linear estimate of a quantity that is known with an error: V the mean square of the contour's tilts, e^2 from
/// `LineTurns` and h the distance to the nearest point that lies out of the point's plane. A point by s out of the plane, at
/// the distance h, counts as one at h (1 + (scale/s)^2): a line drawn almost twice tells nothing of a tilt.
///
/// `slopes` are cosines of the tilts at `points`, of which those in `numbers` (in ascending order, with point 0 and the
/// first of every line) are looked at; of the others as much counts as of the one before them. Returns the cosines of what
/// is believed. Source: Wiener, Extrapolation, Interpolation and Smoothing of Stationary Time Series, 1949.
std::vector<double> believed_slopes(const std::vector<BoundaryPoint>& points, std::span<const std::size_t> numbers,
                                    std::span<const double> slopes, double scale_mm);

}  // namespace kontur
