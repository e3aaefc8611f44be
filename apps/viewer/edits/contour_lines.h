// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "viewer/edits/sketch.h"
#include "viewer/model/model.h"

// What functions that edit contours have in common. Lines are closed or open, as the contour says.

namespace kontur::viewer {

/// `contour` with the line of this sketch instead of its own.
DrawnContour redrawn(const DrawnContour& contour, const std::vector<SketchPoint>& sketch, SliceEdges& edges,
                     SketchOptions options = {.snap = false});

/// How many edges the line has from a point to the next one.
std::size_t edge_count(const DrawnContour& contour);

/// Length of the line from its first point to each point; one more entry for the whole.
std::vector<double> arc_lengths(const DrawnContour& contour);

/// The line's point nearest to `p`.
std::size_t nearest_point(const std::vector<Vec3>& points, const Vec3& p);

/// The number of the point from which the edge nearest to `p` leads on.
std::size_t nearest_edge(const DrawnContour& contour, const Vec3& p);

/// The control point whose stretch the line's point belongs to.
std::size_t stretch_of(const DrawnContour& contour, std::size_t point);

/// The contour with a control point at the line's point `point`; nothing else changes. Returns its number.
std::size_t split_at(DrawnContour& contour, std::size_t point);

/// The number of the control point so many on; beyond an open line's ends there is none.
std::optional<std::size_t> neighbor(std::size_t count, bool is_closed, std::size_t index, std::ptrdiff_t step);

/// A sketch's stretches that the curve or the image decides are made anew where a control point next to them changed: a
/// spline's from two before to one after, a wire's or a line's on both sides.
void forget_paths_at(std::vector<SketchPoint>& sketch, bool is_closed, std::size_t index);

}  // namespace kontur::viewer
