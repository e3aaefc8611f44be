// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/base/work.h"
#include "kontur/moving/whole_motion.h"

namespace kontur {

/// A point of a contour and when it was drawn.
struct PointInTime {
    Vec3 position;        ///< mm
    Vec3 inplane_normal;  ///< unit, outward, in the contour's plane
    double time = 0;
    std::size_t contour = 0;  ///< of all
};

/// How time is laid out as a length: two more coordinates of space. A cycle is a circle, other times a line; `speed` is mm
/// along it for a cycle, or for twice as long as the moments span.
struct TimeAsLength {
    std::optional<double> cycle;
    double first = 0, span = 1;
    double speed_mm = 0;

    std::array<double, 2> at(double time) const;
};

/// About `most` of the points, every so many of them.
std::vector<PointInTime> thinned(std::vector<PointInTime> points, std::size_t most);

/// What such a function is of.
struct SpaceTimeOptions {
    Ball3 ball;  ///< of all that was drawn
    TimeAsLength time;
    const WholeMotion* mean = nullptr;  ///< what f goes back to, away from the points; a radius below 0 where there is none
};

/// f(x, t) as a Gaussian process in space and time at once: the screened kernel of the distance in both (isotropic, no
/// product), around a mean. It knows nothing of ends and bounds; for sections in planes that were drawn at other moments.
/// Dense: of n points (2 n)^3 / 3 flops, three times.
class SpaceTimeFunction {
public:
    /// Throws Error(singular_system) for points that coincide.
    SpaceTimeFunction(const std::vector<PointInTime>& points, const SpaceTimeOptions& options, const Work& work = {});

    std::vector<double> values(const std::vector<Vec3>& points, double time) const;

    /// How far f would be from 0 along contours, if each was left out in turn: the root of the mean square, mm. By their
    /// weights; 0 where there are none. In closed form (Rasmussen & Williams 2006, 5.4.2).
    double left_out_error_mm(const std::vector<double>& weights) const;

private:
    struct Center {
        Vec3 position;  ///< in radii, from the ball's centre
        std::array<double, 2> time;
    };
    /// The places of one contour among the centres, and how many of them lie on it.
    struct Block {
        std::vector<std::size_t> centers;
        std::size_t on_line = 0;
    };
    double square_of_left_out(const Block& block) const;
    Center to_center(const Vec3& p, double time) const;
    double sum_at(const Center& at) const;
    void solve(const std::vector<PointInTime>& places, const std::vector<double>& values,
               const std::vector<double>& smoothing);

    Ball3 ball_;
    TimeAsLength time_;
    std::optional<WholeMotion> mean_;
    std::vector<Center> centers_;
    std::vector<double> weights_;
    std::vector<double> factor_;  ///< see small_cholesky
    std::vector<Block> blocks_;   ///< of each contour
};

}  // namespace kontur
