// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/drawing/drawing.h"
#include "kontur/sampling/moving_point.h"

namespace kontur {

/// The drawn planes as walls. In a plane where everything was drawn, no surface comes through beside the contours. There are
/// also walls beyond the ends of a stack of parallel planes. There the image may rightly show that something goes on, such
/// as the next vertebra, but only the person who drew knows where the object ends.
class Walls {
public:
    /// Planes with an open contour are none: they do not show everything.
    explicit Walls(const Drawing& drawing);

    /// Sets how far the points may move along their normals, backwards and forwards.
    void limit(std::span<MovingPoint> points) const;

    /// Whether a parallelepiped around a point, its half edges given, touches one of the planes; surely, where it nearly
    /// does.
    bool is_in_plane(const Vec3& point, std::span<const Vec3> half_edges) const;
    /// Whether a point lies beyond an end of a stack.
    bool is_beyond_end(const Vec3& point) const;

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
