// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "viewer/edits/slice_edges.h"
#include "viewer/model/model.h"

namespace kontur::viewer {

/// A control point as the user sets it. With `path`, the line to the next control point runs through these points; without,
/// it is made as `kind` says (free: straight). From the last one of an open sketch a path leads to the line's end, which
/// becomes a control point, too.
struct SketchPoint {
    Vec3 at;
    Stretch kind = Stretch::free;
    std::optional<std::vector<Vec3>> path;
    int image = 0;  ///< number of the image whose edges a wire follows
};

struct SketchOptions {
    bool closed = true;
    bool snap = true;  ///< control points of wire stretches move to the edge nearby
    double snap_radius_mm = 3;
    double spline_step_mm = 1;  ///< at most; of a short stretch no more than an eighth of its length
};

/// The line through a sketch: `control` with indices into `points`, all on the plane. Hand-drawn and edge-following
/// stretches are `thinned`. Points that coincide with the one before are left out, so the control points of a very short
/// sketch may be fewer.
struct PlacedSketch {
    std::vector<ControlPoint> control;
    std::vector<Vec3> points;
};
PlacedSketch draw(const std::vector<SketchPoint>& sketch, const Plane& plane, SliceEdges& edges,
                  const SketchOptions& options = {});

/// The contour as a sketch that draws the same line.
std::vector<SketchPoint> sketch_of(const DrawnContour& contour);

/// Drops points while none of them lies farther than 0.1 mm from the remaining line, or than 0.005 of its extent if that is
/// less: what is drawn may be a cell (Douglas and Peucker 1973). Keeps both ends.
std::vector<Vec3> thinned(const std::vector<Vec3>& line);

}  // namespace kontur::viewer
