// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/base/geometry.h"
#include "viewer/edits/contour_edits.h"
#include "viewer/edits/contour_lines.h"

// What is done to the ends of lines: contours that are opened, open lines that are closed or led on.

namespace kontur::viewer {
namespace {

using Sketch = std::vector<SketchPoint>;

std::vector<Vec3> reversed(std::vector<Vec3> path) {
    std::reverse(path.begin(), path.end());
    return path;
}

/// The part from one point of the line to a later one gives way to the path.
DrawnContour with_part(const DrawnContour& line, std::size_t first, std::size_t last, const std::vector<Vec3>& path,
                       SliceEdges& edges) {
    DrawnContour split = line;
    const std::size_t from = split_at(split, first), to = split_at(split, last);
    Sketch sketch = sketch_of(split);
    sketch[from].kind = Stretch::free;
    sketch[from].path = thinned(path);
    sketch.erase(sketch.begin() + static_cast<std::ptrdiff_t>(from) + 1, sketch.begin() + static_cast<std::ptrdiff_t>(to));
    return redrawn(line, sketch, edges);
}

/// From a point of the line on the path leads to its new end.
DrawnContour led_on(const DrawnContour& line, std::size_t point, const std::vector<Vec3>& path, SliceEdges& edges) {
    DrawnContour split = line;
    const std::size_t from = split_at(split, point);
    Sketch sketch = sketch_of(split);
    sketch.resize(from + 1);
    sketch[from].kind = Stretch::free;
    sketch[from].path = thinned(path);
    return redrawn(line, sketch, edges);
}

/// The path leads from a new beginning to a point of the line.
DrawnContour led_up(const DrawnContour& line, std::size_t point, const std::vector<Vec3>& path, SliceEdges& edges) {
    DrawnContour split = line;
    const std::size_t to = split_at(split, point);
    Sketch sketch = sketch_of(split);
    sketch.erase(sketch.begin(), sketch.begin() + static_cast<std::ptrdiff_t>(to));
    const std::vector<Vec3> part = thinned(path);
    sketch.insert(sketch.begin(),
                  {.at = part.front(), .kind = Stretch::free, .path = std::vector<Vec3>(part.begin() + 1, part.end())});
    return redrawn(line, sketch, edges);
}

/// The path leads from the line's end back to its beginning.
DrawnContour led_around(const DrawnContour& line, const std::vector<Vec3>& path, SliceEdges& edges) {
    DrawnContour ring = line;
    ring.closed = true;
    ring.inside.reset();
    Sketch sketch = sketch_of(line);
    sketch.back().kind = Stretch::free;
    sketch.back().path = thinned(path);
    return redrawn(ring, sketch, edges);
}

}  // namespace

DrawnContour redraw_open(const DrawnContour& line, const std::vector<Vec3>& path, SliceEdges& edges) {
    const std::size_t end = line.points.size() - 1;
    const std::size_t from = nearest_point(line.points, path.front()), to = nearest_point(line.points, path.back());
    const auto is_end = [&](std::size_t point) { return point == 0 || point == end; };
    if (is_end(from) && is_end(to) && from != to) {
        if (2 * line_length(path, false) > line_length(line.points, false)) return redraw_whole(line, path, edges);
        return led_around(line, from == end ? path : reversed(path), edges);
    }
    if (!is_end(from) && !is_end(to)) {
        if (from == to)
            throw Error(ErrorKind::invalid_input, "the new part of a contour starts and ends at the same place of it");
        return from < to ? with_part(line, from, to, path, edges) : with_part(line, to, from, reversed(path), edges);
    }
    // One end of the path lies at an end of the line, or beyond it: there is the new end.
    const std::size_t stays = is_end(to) ? from : to, goes = is_end(to) ? to : from;
    const std::vector<Vec3> outwards = is_end(to) ? path : reversed(path);
    return goes == end ? led_on(line, stays, outwards, edges) : led_up(line, stays, reversed(outwards), edges);
}

DrawnContour opened(const DrawnContour& contour, const std::optional<Vec3>& at, SliceEdges& edges) {
    if (!contour.closed) return contour;
    DrawnContour open = contour;
    open.closed = open.hole = false;
    open.end = ContourEnd::automatic;
    std::vector<SketchPoint> sketch = sketch_of(contour);
    const std::size_t gap = at ? stretch_of(contour, nearest_edge(contour, *at)) : sketch.size() - 1;
    if (sketch.size() == 1) {  // one stretch all around: only an edge of it goes
        const std::size_t edge = at ? nearest_edge(contour, *at) : contour.points.size() - 1;
        std::rotate(open.points.begin(), open.points.begin() + static_cast<std::ptrdiff_t>((edge + 1) % open.points.size()),
                    open.points.end());
        return redraw_whole(open, open.points, edges);
    }
    std::rotate(sketch.begin(), sketch.begin() + static_cast<std::ptrdiff_t>((gap + 1) % sketch.size()), sketch.end());
    sketch.back().path.reset();
    return redrawn(open, sketch, edges);
}

DrawnContour closed(const DrawnContour& contour, SliceEdges& edges) {
    if (contour.closed) return contour;
    DrawnContour ring = contour;
    ring.closed = true;
    ring.inside.reset();
    std::vector<SketchPoint> sketch = sketch_of(contour);
    if (sketch.size() > 1 && sketch.back().at == sketch.front().at) sketch.pop_back();
    else sketch.back().path.reset();
    for (const std::size_t index : {sketch.size() - 1, std::size_t{0}, sketch.size() - 2})  // a spline bends with neighbours
        if (index < sketch.size() && sketch[index].kind == Stretch::spline) sketch[index].path.reset();
    return redrawn(ring, sketch, edges);
}

}  // namespace kontur::viewer
