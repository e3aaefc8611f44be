// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/geometry.h"

namespace kontur {

/// An orthographic view onto the patient: `plane.u` runs to the right of the screen, `plane.v` down and `plane.normal`
/// away from the viewer; `plane.origin` is seen at the middle of a picture of width x height pixels.
struct Camera {
    Plane plane;
    int width = 0;
    int height = 0;
    double pixel_mm = 1;

    /// Pixels from the left and top edge (x, y), and z: mm towards the viewer.
    Vec3 project(const Vec3& p) const {
        const auto [u, v] = plane.to_uv(p);
        return {0.5 * width + u / pixel_mm, 0.5 * height + v / pixel_mm, -plane.distance_to(p)};
    }
};

/// The screen plane of a viewer who stands in the direction `towards_viewer` from `origin`, head up (towards S; towards A
/// when he looks along the body).
Plane view_plane(const Vec3& origin, const Vec3& towards_viewer);

/// The camera on `plane` that shows the whole of `points`, centred, leaving `margin` of the picture free on each side.
Camera fit_camera(const Plane& plane, std::span<const Vec3> points, int width, int height, double margin);

}  // namespace kontur
