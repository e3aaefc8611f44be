// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/drawing/drawing.h"
#include "kontur/refine/moving_point.h"

namespace kontur {

/// The drawn planes as walls: in a plane where everything was drawn no surface comes through beside the contours. Beyond the
/// ends of a stack of parallel planes there are walls too, where the image may truthfully show that something goes on (the
/// next vertebra) and only the one who drew knows where the object ends.
class Walls {
public:
    /// Planes with an open contour are none: they do not show everything.
    explicit Walls(const Drawing& drawing);

    /// Sets how far the points may move along their normals, backwards and forwards.
    void limit(std::span<MovingPoint> points) const;

private:
    /// Beyond an end of a stack. Points that lie behind it may not move on.
    struct EndWall {
        Vec3 direction;    ///< unit, out of the stack
        double height_mm;  ///< along it
    };

    std::vector<Plane> planes_;
    std::vector<EndWall> ends_;
};

}  // namespace kontur
