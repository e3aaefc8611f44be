// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/section.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

constexpr std::size_t kStretchEdges = 16;

/// Point i of a closed line and the one before it.
const Point2& before(const Polygon2& line, std::size_t i) { return line[i > 0 ? i - 1 : line.size() - 1]; }

/// The point of an outline that is nearest to p, as edge after edge is looked at.
class NearestPoint {
public:
    explicit NearestPoint(const Point2& p) : p_(p) {}

    /// At the edge that leads to point `end`.
    void look_at(const Polygon2& line, std::size_t end, std::size_t outline) {
        const Point2 &a = before(line, end), &b = line[end];
        const double ux = b[0] - a[0], uy = b[1] - a[1], px = p_[0] - a[0], py = p_[1] - a[1];
        const double length2 = ux * ux + uy * uy;
        const double t = length2 > 0 ? std::clamp((px * ux + py * uy) / length2, 0.0, 1.0) : 0.0;
        const double dx = px - t * ux, dy = py - t * uy;
        if (dx * dx + dy * dy >= distance2_) return;
        distance2_ = dx * dx + dy * dy;
        found_ = {0, {a[0] + t * ux, a[1] + t * uy}, outline, end};
    }

    double distance2() const { return distance2_; }

    Section::Nearest found() const {
        Section::Nearest result = found_;
        result.distance = std::sqrt(distance2_);
        return result;
    }

private:
    Point2 p_;
    double distance2_ = std::numeric_limits<double>::infinity();
    Section::Nearest found_;
};

/// Each edge as a mass at its middle.
Vec3 middle_of_lines(const ContourSet& set, const std::vector<std::size_t>& contours) {
    Vec3 sum;
    double mass = 0;
    for (const std::size_t c : contours)
        for_each_edge(set.contours[c].points, [&](const Vec3& a, const Vec3& b) {
            sum += distance(a, b) / 2 * (a + b);
            mass += distance(a, b);
        });
    return mass > 0 ? sum / mass : set.contours[contours.front()].points.front();
}

}  // namespace

double area(const Polygon2& outline) {
    double twice = 0;
    const Point2& origin = outline.front();
    for_each_edge(outline, [&](const Point2& a, const Point2& b) {
        twice += (a[0] - origin[0]) * (b[1] - origin[1]) - (b[0] - origin[0]) * (a[1] - origin[1]);
    });
    return std::abs(twice) / 2;
}

double perimeter(const Polygon2& outline) {
    double length = 0;
    for_each_edge(outline, [&](const Point2& a, const Point2& b) { length += std::hypot(b[0] - a[0], b[1] - a[1]); });
    return length;
}

double distance_to_segment(const Point2& p, const Point2& a, const Point2& b) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], px = p[0] - a[0], py = p[1] - a[1];
    const double length2 = ux * ux + uy * uy;
    const double t = length2 > 0 ? std::clamp((px * ux + py * uy) / length2, 0.0, 1.0) : 0;
    return std::hypot(px - t * ux, py - t * uy);
}

std::vector<std::vector<double>> row_crossings(const Polygon2& outline, double first_mm, double step_mm, int rows) {
    std::vector<std::vector<double>> crossings(static_cast<std::size_t>(rows));
    const auto first_above = [&](double y) {
        return static_cast<std::size_t>(std::clamp(std::ceil((y - first_mm) / step_mm), 0.0, static_cast<double>(rows)));
    };
    for_each_edge(outline, [&](const Point2& a, const Point2& b) {
        const Point2 &low = a[1] < b[1] ? a : b, &high = a[1] < b[1] ? b : a;
        for (std::size_t row = first_above(low[1]), end = first_above(high[1]); row < end; ++row) {
            const double y = first_mm + step_mm * static_cast<double>(row);
            crossings[row].push_back(low[0] + (y - low[1]) * (high[0] - low[0]) / (high[1] - low[1]));
        }
    });
    for (std::vector<double>& row : crossings) std::ranges::sort(row);
    return crossings;
}

bool Section::contains(const Point2& p) const {
    int layers = 0;
    for (std::size_t o = 0; o < outlines.size(); ++o)
        if (is_inside(outlines[o], p)) layers += layer(o);
    return layers > 0;
}

Section::Nearest Section::nearest(const Point2& p) const {
    NearestPoint nearest(p);
    for (std::size_t o = 0; o < outlines.size(); ++o)
        for (std::size_t i = 0; i < outlines[o].size(); ++i) nearest.look_at(outlines[o], i, o);
    return nearest.found();
}

Section section_of(const Contour& contour, const Plane& plane) {
    Section section{plane, {Polygon2{}}, {}, {}};
    for (const Vec3& p : contour.points) section.outlines.front().push_back(plane.to_uv(p));
    return section;
}

SectionSearch::SectionSearch(const Section& section) : section_(section) {
    std::vector<Box2> outlines(section.outlines.size()), stretches;
    for (std::size_t o = 0; o < section.outlines.size(); ++o) {
        const Polygon2& outline = section.outlines[o];
        first_stretch_.push_back(stretches_.size());
        for (std::size_t begin = 0; begin < outline.size(); begin += kStretchEdges) {
            Stretch stretch{o, begin, std::min(begin + kStretchEdges, outline.size()), {}};
            stretch.box.extend(before(outline, begin));
            for (std::size_t i = begin; i < stretch.end; ++i) stretch.box.extend(outline[i]);
            outlines[o].extend(stretch.box);
            stretches.push_back(stretch.box);
            stretches_.push_back(stretch);
        }
    }
    first_stretch_.push_back(stretches_.size());
    outline_tree_ = BoxTree(std::move(outlines));
    stretch_tree_ = BoxTree(std::move(stretches));
}

bool SectionSearch::encloses(std::size_t o, const Point2& p) const {
    const Polygon2& outline = section_.outlines[o];
    bool inside = false;
    for (std::size_t s = first_stretch_[o]; s < first_stretch_[o + 1]; ++s) {
        const Stretch& stretch = stretches_[s];
        if (stretch.box.low[1] > p[1] || stretch.box.high[1] <= p[1]) continue;  // no edge goes from one side to the other
        for (std::size_t i = stretch.begin; i < stretch.end; ++i)
            inside ^= passes_right_of(p, before(outline, i), outline[i]);
    }
    return inside;
}

bool SectionSearch::contains(const Point2& p) const {
    int layers = 0;
    visit_around(p, [&](std::size_t outline) { layers += section_.layer(outline); });
    return layers > 0;
}

Section::Nearest SectionSearch::nearest(const Point2& p) const {
    // Bounds are compared with room for their rounding.
    constexpr double kLess = 1 - 1e-12;
    NearestPoint nearest(p);
    std::size_t nearest_stretch = stretches_.size();
    const auto look_at = [&](std::size_t s) {
        const Stretch& stretch = stretches_[s];
        const Polygon2& outline = section_.outlines[stretch.outline];
        NearestPoint here(p);
        for (std::size_t i = stretch.begin; i < stretch.end; ++i) here.look_at(outline, i, stretch.outline);
        // Of places equally near the section finds the first.
        if (std::pair(here.distance2(), s) >= std::pair(nearest.distance2(), nearest_stretch)) return;
        nearest = here;
        nearest_stretch = s;
    };
    stretch_tree_.visit([&](const Box2& box) { return kLess * box.distance2(p); }, [&] { return nearest.distance2(); },
                        look_at);
    return nearest.found();
}

std::vector<Section> sections_of(const ContourSet& set, double tolerance_mm) {
    const std::vector<std::size_t> plane = shared_planes(set.contours, tolerance_mm);
    std::vector<Section> sections;
    std::vector<std::size_t> drawn_in;  // for each section, whose plane it has
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        if (!set.contours[c].closed) continue;
        const auto at = static_cast<std::size_t>(std::find(drawn_in.begin(), drawn_in.end(), plane[c]) - drawn_in.begin());
        if (at == sections.size()) {
            drawn_in.push_back(plane[c]);
            sections.emplace_back().plane = set.contours[plane[c]].plane;
        }
        sections[at].contours.push_back(c);
        sections[at].holes.push_back(set.contours[c].hole);
    }
    for (Section& section : sections) {
        const Vec3 middle = middle_of_lines(set, section.contours);
        section.plane.origin = middle - section.plane.distance_to(middle) * section.plane.normal;
        for (const std::size_t c : section.contours) {
            Polygon2& outline = section.outlines.emplace_back();
            for (const Vec3& p : set.contours[c].points) outline.push_back(section.plane.to_uv(p));
        }
    }
    return sections;
}

bool are_parallel(const Plane& a, const Plane& b) {
    constexpr double kCosine = 0.995;
    return std::abs(dot(a.normal, b.normal)) >= kCosine;
}

}  // namespace kontur
