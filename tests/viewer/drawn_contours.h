// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "kontur/shape/volume.h"
#include "viewer/edits/sketch.h"

namespace kontur::viewer::test {

/// An image without any edge.
inline std::shared_ptr<const Image> flat_image() {
    return std::make_shared<const Image>(Image{{{40, 40, 40}, {}}, std::vector<std::int16_t>(64000, 0)});
}

inline const Plane kPlane{{20, 20, 20}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};

inline std::vector<Vec3> circle(std::size_t count, double radius = 10) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
        points.push_back(kPlane.from_uv(radius * std::cos(angle), radius * std::sin(angle)));
    }
    return points;
}

inline DrawnContour circle_of(std::size_t count, Stretch kind, SliceEdges& edges) {
    std::vector<SketchPoint> sketch;
    for (const Vec3& p : circle(count)) sketch.push_back({p, kind, {}});
    const PlacedSketch drawing = draw(sketch, kPlane, edges, {.snap = false});
    DrawnContour contour;
    contour.id = 7;
    contour.structure = 3;
    contour.plane = kPlane;
    contour.control = drawing.control;
    contour.points = drawing.points;
    return contour;
}

inline DrawnContour freehand_circle(std::size_t count) {
    DrawnContour contour = as_drawn({kPlane, circle(count), true, false});
    contour.id = 7;
    contour.structure = 3;
    return contour;
}

}  // namespace kontur::viewer::test
