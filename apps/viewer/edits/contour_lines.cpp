// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/contour_lines.h"

#include <algorithm>
#include <limits>

#include "viewer/edits/contour_edits.h"

namespace kontur::viewer {

DrawnContour redrawn(const DrawnContour& contour, const std::vector<SketchPoint>& sketch, SliceEdges& edges,
                     SketchOptions options) {
    options.closed = contour.closed;
    DrawnContour result = draw_contour(sketch, contour.plane, edges, options);
    result.id = contour.id;
    result.structure = contour.structure;
    result.visible = contour.visible;
    copy_marks(contour, result);
    result.time = contour.time;
    return result;
}

std::size_t edge_count(const DrawnContour& contour) { return contour.points.size() - (contour.closed ? 0 : 1); }

std::vector<double> arc_lengths(const DrawnContour& contour) {
    const std::vector<Vec3>& points = contour.points;
    std::vector<double> lengths{0};
    for (std::size_t i = 0; i < edge_count(contour); ++i)
        lengths.push_back(lengths.back() + distance(points[i], points[(i + 1) % points.size()]));
    if (!contour.closed) lengths.push_back(lengths.back());
    return lengths;
}

std::size_t nearest_point(const std::vector<Vec3>& points, const Vec3& p) {
    const auto nearest = std::min_element(points.begin(), points.end(),
                                          [&](const Vec3& a, const Vec3& b) { return distance(a, p) < distance(b, p); });
    return static_cast<std::size_t>(nearest - points.begin());
}

std::size_t nearest_edge(const DrawnContour& contour, const Vec3& p) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < edge_count(contour); ++n) {
        const double away = distance_to_segment(p, contour.points[n], contour.points[(n + 1) % contour.points.size()]);
        if (away < least) least = away, nearest = n;
    }
    return nearest;
}

std::size_t stretch_of(const DrawnContour& contour, std::size_t point) {
    const auto after = std::upper_bound(contour.control.begin(), contour.control.end(), point,
                                        [](std::size_t p, const ControlPoint& c) { return p < c.index; });
    return static_cast<std::size_t>(after - contour.control.begin()) - 1;
}

std::size_t split_at(DrawnContour& contour, std::size_t point) {
    const std::size_t stretch = stretch_of(contour, point);
    if (contour.control[stretch].index == point) return stretch;
    contour.control.insert(contour.control.begin() + static_cast<std::ptrdiff_t>(stretch) + 1,
                           {contour.points[point], contour.control[stretch].kind, point, contour.control[stretch].image});
    return stretch + 1;
}

std::optional<std::size_t> neighbor(std::size_t count, bool is_closed, std::size_t index, std::ptrdiff_t step) {
    const auto all = static_cast<std::ptrdiff_t>(count), at = static_cast<std::ptrdiff_t>(index) + step;
    if (!is_closed && (at < 0 || at >= all)) return std::nullopt;
    return static_cast<std::size_t>((at + 2 * all) % all);
}

void forget_paths_at(std::vector<SketchPoint>& sketch, bool is_closed, std::size_t index) {
    for (const std::ptrdiff_t step : {-2, -1, 0, 1}) {
        const std::optional<std::size_t> at = neighbor(sketch.size(), is_closed, index, step);
        if (!at) continue;
        SketchPoint& point = sketch[*at];
        const bool touches = step == -1 || step == 0;
        if (point.kind == Stretch::spline || (touches && point.kind != Stretch::free)) point.path.reset();
    }
}

}  // namespace kontur::viewer
