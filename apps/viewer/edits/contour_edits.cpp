// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/contour_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/error.h"
#include "kontur/shape/self_intersections.h"
#include "viewer/edits/contour_lines.h"

namespace kontur::viewer {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::invalid_input, message); }

void check_index(const DrawnContour& contour, std::size_t index) {
    if (index >= contour.control.size())
        refuse(fmt::format("the contour has {} control points; number {} is none of them", contour.control.size(), index));
}

/// Moves a free stretch's end by `by`, and its other points with it, less and less towards the other end.
void bend(std::vector<Vec3>& path, const Vec3& by, bool at_start) {
    const auto count = static_cast<double>(path.size() + 1);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const double along = static_cast<double>(i + 1) / count;
        path[i] += (at_start ? 1 - along : along) * by;
    }
}

/// The same line with further points: within `reach_mm` of a place no two are farther apart than `step_mm`. Straight parts
/// of what a hand drew have none between their ends.
DrawnContour finer(const DrawnContour& contour, const Vec3& place, double reach_mm, double step_mm) {
    DrawnContour line = contour;
    line.points.clear();
    for (std::size_t n = 0; n < contour.points.size(); ++n) {
        const Vec3 &from = contour.points[n], &to = contour.points[(n + 1) % contour.points.size()];
        for (std::size_t c = 0; c < contour.control.size(); ++c)
            if (contour.control[c].index == n) line.control[c].index = line.points.size();
        line.points.push_back(from);
        if (n == edge_count(contour) || distance_to_segment(place, from, to) > reach_mm) continue;
        const double steps = std::ceil(distance(from, to) / step_mm);
        for (double step = 1; step < steps; ++step) line.points.push_back(from + (step / steps) * (to - from));
    }
    return line;
}

DrawnContour moved(DrawnContour contour, const Vec3& by) {
    for (Vec3& p : contour.points) p += by;
    for (ControlPoint& c : contour.control) c.at += by;
    return contour;
}

}  // namespace

DrawnContour draw_contour(const std::vector<SketchPoint>& sketch, const Plane& plane, SliceEdges& edges,
                          const SketchOptions& options) {
    PlacedSketch drawing = draw(sketch, plane, edges, options);
    DrawnContour contour;
    contour.plane = plane;
    contour.control = std::move(drawing.control);
    contour.points = std::move(drawing.points);
    contour.closed = options.closed;
    if (!contour.closed && contour.points.size() < 2) refuse("an open line needs at least two points");
    if (contour.closed &&
        (contour.points.size() < 3 || !(width_mm(contour.points) > ContourCheckOptions{}.line_tolerance_mm)))
        refuse("a contour needs at least three points that do not lie on one line");
    return contour;
}

DrawnContour move_point(const DrawnContour& contour, std::size_t index, const Vec3& to, SliceEdges& edges,
                        const SketchOptions& options) {
    check_index(contour, index);
    std::vector<SketchPoint> sketch = sketch_of(contour);
    const std::size_t count = sketch.size();
    // What a hand drew in one go bends near the point alone.
    if (count == 1 || (!contour.closed && count == 2 && kind_name(contour) == "freehand"))
        return pull(contour, contour.control[index].at, to, {}, edges);
    SketchPoint& point = sketch[index];
    const Vec3 by = to - point.at;
    point.at = to;
    if (point.kind == Stretch::free) bend(*point.path, by, true);
    // Before an open line's first point there is nothing.
    SketchPoint& before = sketch[neighbor(count, contour.closed, index, -1).value_or(index)];
    if (&before != &point && before.kind == Stretch::free) bend(*before.path, by, false);
    forget_paths_at(sketch, contour.closed, index);
    SketchOptions snapping = options;
    snapping.snap = options.snap && (point.kind == Stretch::wire || before.kind == Stretch::wire);
    // Only the moved point may jump to an edge; its neighbours lie where the user left them.
    const int image = point.kind == Stretch::wire ? point.image : before.image;
    if (snapping.snap) sketch[index].at = edges.snap(contour.plane, to, options.snap_radius_mm, image);
    snapping.snap = false;
    return redrawn(contour, sketch, edges, snapping);
}

DrawnContour insert_point(const DrawnContour& contour, const Vec3& at, SliceEdges& edges) {
    const std::size_t nearest = nearest_point(contour.points, at);
    DrawnContour split = contour;
    const std::size_t before = split.control.size(), index = split_at(split, nearest);
    if (split.control.size() == before) refuse("there is a control point at this place already");
    std::vector<SketchPoint> sketch = sketch_of(split);
    if (sketch[index].kind == Stretch::free) return split;
    sketch[index].at = at;
    forget_paths_at(sketch, contour.closed, index);
    return redrawn(contour, sketch, edges);
}

DrawnContour delete_point(const DrawnContour& contour, std::size_t index, SliceEdges& edges) {
    check_index(contour, index);
    std::vector<SketchPoint> sketch = sketch_of(contour);
    const std::size_t least = !contour.closed ? 2 : kind_name(contour) == "freehand" ? 1 : 3;
    if (sketch.size() <= least)
        refuse(fmt::format("the contour has {} control points, which it needs; delete the contour instead", sketch.size()));
    const std::size_t count = sketch.size(), before = (index + count - 1) % count;
    if (!contour.closed && (index == 0 || index + 1 == count)) {  // the line ends at the next one
        if (index > 0) sketch[before].path.reset();
        forget_paths_at(sketch, false, index);
        sketch.erase(sketch.begin() + static_cast<std::ptrdiff_t>(index));
        return redrawn(contour, sketch, edges);
    }
    if (sketch[before].kind == Stretch::free || sketch[index].kind == Stretch::free) {
        // A free stretch is kept as it was drawn, so the point only stops being one to drag.
        sketch[before].kind = Stretch::free;
        sketch[before].path->push_back(sketch[index].at);
        sketch[before].path->insert(sketch[before].path->end(), sketch[index].path->begin(), sketch[index].path->end());
        sketch.erase(sketch.begin() + static_cast<std::ptrdiff_t>(index));
    } else {
        sketch[before].path.reset();
        forget_paths_at(sketch, contour.closed, index);
        sketch.erase(sketch.begin() + static_cast<std::ptrdiff_t>(index));
    }
    return redrawn(contour, sketch, edges);
}

DrawnContour pull(const DrawnContour& drawn, const Vec3& from, const Vec3& to, std::optional<double> radius_mm,
                  SliceEdges& edges) {
    constexpr double kSteps = 8;  // within the radius
    const double radius = radius_mm.value_or(arc_lengths(drawn).back() / 8);
    if (!(radius > 0)) refuse(fmt::format("the radius of a pull is {:g} mm; more than 0 is needed", radius));
    const DrawnContour contour = finer(drawn, from, radius, radius / kSteps);
    const std::vector<double> at = arc_lengths(contour);
    const double whole = contour.closed ? at.back() : std::numeric_limits<double>::infinity();
    const std::size_t grabbed = nearest_point(contour.points, from);
    const Vec3 by = to - from;
    DrawnContour bent = contour;
    for (std::size_t i = 0; i < contour.points.size(); ++i) {
        const double direct = std::abs(at[i] - at[grabbed]), away = std::min(direct, whole - direct) / radius;
        if (away >= 1) continue;
        const double weight = (1 - away * away) * (1 - away * away);
        bent.points[i] += weight * by;
        bent.control[stretch_of(contour, i)].kind = Stretch::free;
    }
    for (ControlPoint& c : bent.control) c.at = bent.points[c.index];
    return redrawn(contour, sketch_of(bent), edges);
}

std::optional<DrawnContour> bent(const DrawnContour& contour, const std::function<std::optional<Vec3>(const Vec3&)>& goes_to,
                                 double step_mm, SliceEdges& edges) {
    DrawnContour line = contour;
    line.points.clear();
    bool any = false;
    const std::size_t count = contour.points.size();
    for (std::size_t n = 0; n < count; ++n) {
        const std::size_t own = stretch_of(contour, n);
        if (contour.control[own].index == n) line.control[own].index = line.points.size();
        const Vec3& from = contour.points[n];
        // Behind an open line's end there is no edge: it alone is asked.
        const Vec3 along = n == edge_count(contour) ? Vec3{} : contour.points[(n + 1) % count] - from;
        const auto steps = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(norm(along) / step_mm)));
        std::vector<Vec3> places;
        std::vector<std::optional<Vec3>> targets;
        for (std::size_t step = 0; step <= steps; ++step) {
            places.push_back(from + (static_cast<double>(step) / static_cast<double>(steps)) * along);
            targets.push_back(goes_to(places.back()));
        }
        line.points.push_back(targets[0].value_or(from));
        // What stays beside what moves is a point, too: the line leads straight on from there.
        for (std::size_t step = 1; step < steps; ++step)
            if (targets[step - 1] || targets[step] || targets[step + 1])
                line.points.push_back(targets[step].value_or(places[step]));
        const bool moves = std::any_of(targets.begin(), targets.end(), [](const auto& to) { return to.has_value(); });
        if (moves) line.control[own].kind = Stretch::free;
        any = any || moves;
    }
    if (!any) return std::nullopt;
    for (ControlPoint& c : line.control) c.at = line.points[c.index];
    return redrawn(contour, sketch_of(line), edges);
}

DrawnContour redraw(const DrawnContour& contour, const std::vector<Vec3>& path, SliceEdges& edges) {
    if (path.size() < 2) refuse("the new part of a contour has fewer than 2 points");
    if (!contour.closed) return redraw_open(contour, path, edges);
    const std::vector<double> at = arc_lengths(contour);
    std::size_t first = nearest_point(contour.points, path.front()), last = nearest_point(contour.points, path.back());
    if (first == last) refuse("the new part of a contour starts and ends at the same place of it");
    std::vector<Vec3> part = path;
    const double forward = last > first ? at[last] - at[first] : at.back() - at[first] + at[last];
    if (forward > at.back() / 2) {
        std::swap(first, last);
        std::reverse(part.begin(), part.end());
    }
    // The line from `last` onwards to `first` stays, then the new part leads back.
    DrawnContour split = contour;
    split_at(split, first);
    const std::size_t start = split_at(split, last);
    std::vector<SketchPoint> sketch = sketch_of(split);
    std::rotate(sketch.begin(), sketch.begin() + static_cast<std::ptrdiff_t>(start), sketch.end());
    const auto replaced =
        std::find_if(sketch.begin() + 1, sketch.end(), [&](const SketchPoint& p) { return p.at == contour.points[first]; });
    sketch.erase(std::next(replaced), sketch.end());
    sketch.back().kind = Stretch::free;
    sketch.back().path = thinned(part);
    return redrawn(contour, sketch, edges);
}

DrawnContour redraw_whole(const DrawnContour& contour, const std::vector<Vec3>& path, SliceEdges& edges) {
    const std::size_t least = contour.closed ? 3 : 2;
    if (path.size() < least) refuse(fmt::format("the new line of a contour has fewer than {} points", least));
    const std::vector<Vec3> rest(path.begin() + 1, path.end());
    return redrawn(contour, {{.at = path.front(), .kind = Stretch::free, .path = rest}}, edges);
}

DrawnContour translate(const DrawnContour& contour, const Vec3& by) {
    return moved(contour, by - dot(by, contour.plane.normal) * contour.plane.normal);
}

DrawnContour offset(const DrawnContour& contour, double offset_mm) {
    const Vec3 by = offset_mm * contour.plane.normal;
    DrawnContour copy = moved(contour, by);
    copy.plane.origin += by;
    return copy;
}

std::vector<Vec3> self_crossings(const DrawnContour& contour, std::size_t most) {
    Polygon2 polygon;
    for (const Vec3& p : contour.points) {
        const Point2 at = contour.plane.to_uv(p);
        if (polygon.empty() || polygon.back() != at) polygon.push_back(at);
    }
    const bool has_last_edge = contour.closed || polygon.front() == polygon.back();
    while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
    std::vector<Vec3> crossings;
    if (polygon.size() < 4) return crossings;  // three points cannot cross
    for (const SelfIntersection& contact : find_self_intersections(polygon).places) {
        const bool is_drawn = has_last_edge || contact.second + 1 < polygon.size();
        if (is_drawn && contact.kind == SelfIntersection::Kind::crossing && crossings.size() < most)
            crossings.push_back(contour.plane.from_uv(contact.position));
    }
    return crossings;
}

}  // namespace kontur::viewer
