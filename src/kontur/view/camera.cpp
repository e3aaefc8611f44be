// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/camera.h"

#include <algorithm>

namespace kontur {

Plane view_plane(const Vec3& origin, const Vec3& towards_viewer) {
    const Vec3 away = -normalized(towards_viewer);
    const bool along_body = std::abs(away.z) > 0.999;
    const Vec3 right = normalized(cross(away, along_body ? Vec3{0, -1, 0} : Vec3{0, 0, 1}));
    return {origin, away, right, cross(away, right)};
}

Camera fit_camera(const Plane& plane, std::span<const Vec3> points, int width, int height, double margin) {
    Camera camera{plane, width, height, 1};
    Box3 box;
    for (const Vec3& p : points) {
        const auto [u, v] = plane.to_uv(p);
        box.extend({u, v, 0});
    }
    if (box.is_empty()) return camera;
    camera.plane.origin = plane.from_uv(box.center().x, box.center().y);
    const double free = 1 - 2 * margin;
    const double needed = std::max(box.size().x / (free * width), box.size().y / (free * height));
    if (needed > 0) camera.pixel_mm = needed;
    return camera;
}

}  // namespace kontur
