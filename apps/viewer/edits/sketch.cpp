// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/sketch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/shape/spline.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

constexpr double kThinning_mm = 0.1, kThinning = 0.005;  // the latter of the extent
constexpr double kSamePoint_mm = 1e-6;

/// What lies on the plane to rounding keeps its last bits, so that drawing a contour again changes nothing.
Vec3 projected(const Vec3& p, const Plane& plane) {
    const double off = plane.distance_to(p);
    return std::abs(off) <= 1e-9 ? p : p - off * plane.normal;
}

/// A sketch on its plane, and the lines between its control points.
class Sketcher {
public:
    Sketcher(const std::vector<SketchPoint>& sketch, const Plane& plane, SliceEdges& edges, const SketchOptions& options)
        : sketch_(sketch), plane_(plane), edges_(edges), options_(options) {
        if (!options_.closed) end_by_a_point();
        for (std::size_t i = 0; i < sketch_.size(); ++i) place(sketch_[i], i > 0 ? &sketch_[i - 1] : nullptr);
    }

    PlacedSketch draw() const {
        PlacedSketch drawing;
        for (std::size_t i = 0; i < sketch_.size(); ++i) {
            const std::vector<Vec3> line = stretch(i);
            if (!drawing.points.empty() && distance(drawing.points.back(), sketch_[i].at) < kSamePoint_mm) {
                // The control point's own place wins over the line's last point; two control points at one place are one.
                if (drawing.control.back().index + 1 == drawing.points.size()) drawing.control.pop_back();
                drawing.points.pop_back();
            }
            drawing.control.push_back({sketch_[i].at, sketch_[i].kind, drawing.points.size(), sketch_[i].image});
            drawing.points.push_back(sketch_[i].at);
            for (const Vec3& p : line)
                if (distance(drawing.points.back(), p) >= kSamePoint_mm) drawing.points.push_back(p);
        }
        close(drawing);
        return drawing;
    }

private:
    void end_by_a_point() {
        SketchPoint& last = sketch_.back();
        const std::vector<Vec3> path = last.path.value_or(std::vector<Vec3>{});
        if (path.empty()) return;
        last.path = std::vector<Vec3>(path.begin(), path.end() - 1);
        sketch_.push_back({path.back(), last.kind, {}, last.image});
    }

    void place(SketchPoint& point, const SketchPoint* before) const {
        point.at = projected(point.at, plane_);
        const bool on_wire =
            (point.kind == Stretch::wire && !point.path) || (before && before->kind == Stretch::wire && !before->path);
        const int image = point.kind == Stretch::wire || !before ? point.image : before->image;
        if (options_.snap && on_wire) point.at = edges_.snap(plane_, point.at, options_.snap_radius_mm, image);
        if (point.path)
            for (Vec3& p : *point.path) p = projected(p, plane_);
    }

    /// Whether a line leads on from the control point.
    bool leads_on(std::size_t i) const { return options_.closed || i + 1 < sketch_.size(); }

    /// The points between control point `i` and the next one, both left out.
    std::vector<Vec3> stretch(std::size_t i) const {
        if (!leads_on(i)) return {};
        const SketchPoint& from = sketch_[i];
        const Vec3& to = neighbour(i, 1);
        if (from.path) return *from.path;
        std::vector<Vec3> line;
        if (from.kind == Stretch::spline)
            line = spline_stretch(neighbour(i, -1), from.at, to, neighbour(i, 2), spline_step_mm(from.at, to));
        if (from.kind == Stretch::wire) {
            line = edges_.path(plane_, from.at, to, from.image);
            line.push_back(to);
            line = thinned(line);
            line.pop_back();
        }
        if (!line.empty()) line.erase(line.begin());
        return line;
    }

    double spline_step_mm(const Vec3& from, const Vec3& to) const {
        constexpr double kFewestSteps = 8;
        const double length = distance(from, to);
        return length > 0 ? std::min(options_.spline_step_mm, length / kFewestSteps) : options_.spline_step_mm;
    }

    const Vec3& neighbour(std::size_t i, std::ptrdiff_t step) const {
        const auto count = static_cast<std::ptrdiff_t>(sketch_.size()), at = static_cast<std::ptrdiff_t>(i) + step;
        const auto index = options_.closed ? (at + count) % count : std::clamp<std::ptrdiff_t>(at, 0, count - 1);
        return sketch_[static_cast<std::size_t>(index)].at;
    }

    void close(PlacedSketch& drawing) const {
        while (options_.closed && drawing.points.size() > 1 && drawing.control.back().index + 1 < drawing.points.size() &&
               distance(drawing.points.back(), drawing.points.front()) < kSamePoint_mm)
            drawing.points.pop_back();
    }

    std::vector<SketchPoint> sketch_;
    const Plane& plane_;
    SliceEdges& edges_;
    const SketchOptions& options_;
};

}  // namespace

std::vector<Vec3> thinned(const std::vector<Vec3>& line) {
    if (line.size() < 3) return line;
    const double tolerance_mm = std::min(kThinning_mm, kThinning * bounding_box(line).diagonal());
    std::vector<bool> kept(line.size(), false);
    kept.front() = kept.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        std::size_t worst = first;
        double farthest = tolerance_mm;
        for (std::size_t i = first + 1; i < last; ++i)
            if (const double d = distance_to_segment(line[i], line[first], line[last]); d > farthest)
                farthest = d, worst = i;
        if (worst == first) continue;
        kept[worst] = true;
        open.push_back({first, worst});
        open.push_back({worst, last});
    }
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < line.size(); ++i)
        if (kept[i]) result.push_back(line[i]);
    return result;
}

PlacedSketch draw(const std::vector<SketchPoint>& sketch, const Plane& plane, SliceEdges& edges,
                  const SketchOptions& options) {
    if (sketch.empty()) throw Error(ErrorKind::invalid_input, "a drawing has no control point; at least 1 is needed");
    PlacedSketch drawing = Sketcher(sketch, plane, edges, options).draw();
    if (drawing.points.size() > kMostPoints)
        throw Error(ErrorKind::too_large,
                    fmt::format("a drawing has {} points; the limit is {}", drawing.points.size(), kMostPoints));
    return drawing;
}

std::vector<SketchPoint> sketch_of(const DrawnContour& contour) {
    std::vector<SketchPoint> sketch;
    for (std::size_t i = 0; i < contour.control.size(); ++i) {
        const ControlPoint& c = contour.control[i];
        const std::size_t end = i + 1 < contour.control.size() ? contour.control[i + 1].index : contour.points.size();
        sketch.push_back({c.at, c.kind,
                          std::vector<Vec3>(contour.points.begin() + static_cast<std::ptrdiff_t>(c.index) + 1,
                                            contour.points.begin() + static_cast<std::ptrdiff_t>(end)),
                          c.image});
    }
    return sketch;
}

}  // namespace kontur::viewer
