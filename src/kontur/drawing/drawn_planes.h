// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/drawing/image_box.h"
#include "kontur/shape/section.h"

namespace kontur {

/// A contour set and what several steps want to know of it. The set must outlive it.
struct DrawnPlanes {
    explicit DrawnPlanes(const ContourSet& drawn) : DrawnPlanes(drawn, smallest_ball(drawn)) {}
    DrawnPlanes(const ContourSet& drawn, const Ball3& around);

    const ContourSet& set;
    Ball3 ball;           ///< the smallest one around the set
    double tolerance_mm;  ///< planes less than this apart do not follow one another: 0.15 % of the ball's diameter
    std::vector<Section> sections;
    std::optional<ImageBox> image{};  ///< that it was drawn on, where that is known

    struct Next {
        const Section* section;
        double distance_mm;
    };
    /// The next one parallel to a plane, ahead of its origin in the direction of its normal times `sign`.
    std::optional<Next> next(const Plane& plane, double sign) const;
};

}  // namespace kontur
