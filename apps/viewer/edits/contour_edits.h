// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "viewer/edits/sketch.h"
#include "viewer/model/model.h"

// What can be done to a contour: each function returns the changed contour, with the id of the old one, and throws
// Error(invalid_input) for what cannot be done.

namespace kontur::viewer {

/// Makes a contour of a sketch. A closed one needs three points that do not lie on one line, an open one two points.
DrawnContour draw_contour(const std::vector<SketchPoint>& sketch, const Plane& plane, SliceEdges& edges,
                          const SketchOptions& options = {});

/// Moves a control point; the stretches that depend on it are made anew, free ones bend with it.
DrawnContour move_point(const DrawnContour& contour, std::size_t index, const Vec3& to, SliceEdges& edges,
                        const SketchOptions& options);

/// A further control point: at `at` on a spline, wire or straight stretch, on the line's nearest point of a free one.
DrawnContour insert_point(const DrawnContour& contour, const Vec3& at, SliceEdges& edges);

/// Joins the two stretches at a control point; without its last point an open line ends at the one before. The last three
/// control points cannot be deleted, nor an open line's last two, nor the only one.
DrawnContour delete_point(const DrawnContour& contour, std::size_t index, SliceEdges& edges);

/// Moves the line's point nearest to `from` by `to - from`, and its neighbours along the line within the radius less and
/// less. Stretches that it bends become free.
DrawnContour pull(const DrawnContour& contour, const Vec3& from, const Vec3& to, std::optional<double> radius_mm,
                  SliceEdges& edges);

/// Moves places of the line to where `goes_to` says, nullopt for those that stay; of what moves, no two points are left
/// farther than `step_mm` apart. Stretches that it bends become free. nullopt where nothing moves.
std::optional<DrawnContour> bent(const DrawnContour& contour, const std::function<std::optional<Vec3>(const Vec3&)>& goes_to,
                                 double step_mm, SliceEdges& edges);

/// Replaces the shorter part of the line between the points nearest to the path's two ends by the path; of an open line the
/// part between them.
DrawnContour redraw(const DrawnContour& contour, const std::vector<Vec3>& path, SliceEdges& edges);

/// The same of an open line. Where the path goes on beyond an end of it, the line leads there from now on. From one end to
/// the other one it closes the line, if it is shorter than half of it; else it is the line.
DrawnContour redraw_open(const DrawnContour& line, const std::vector<Vec3>& path, SliceEdges& edges);

/// Leaves out the stretch between control points that is nearest to `at`, or else the last one: an open line. Of a line
/// without other control points than its first one, only an edge of it.
DrawnContour opened(const DrawnContour& contour, const std::optional<Vec3>& at, SliceEdges& edges);

/// Leads an open line on from its end to its beginning, as its last control point says.
DrawnContour closed(const DrawnContour& contour, SliceEdges& edges);

/// Replaces the whole line by the path, whose last point a closed line follows by its first.
DrawnContour redraw_whole(const DrawnContour& contour, const std::vector<Vec3>& path, SliceEdges& edges);

/// Moves all of it within its plane; what of `by` leads out of it is left out.
DrawnContour translate(const DrawnContour& contour, const Vec3& by);

/// The same line in the parallel plane at this distance along the normal.
DrawnContour offset(const DrawnContour& contour, double offset_mm);

/// Where the line crosses itself, in mm; where it only touches itself it does not. At most `most` places. O(n log n).
std::vector<Vec3> self_crossings(const DrawnContour& contour, std::size_t most = 20);

}  // namespace kontur::viewer
