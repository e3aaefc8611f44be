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

    void look_at(const Point2& a, const Point2& b, std::size_t outline) {
        const double ux = b[0] - a[0], uy = b[1] - a[1], px = p_[0] - a[0], py = p_[1] - a[1];
        const double length2 = ux * ux + uy * uy;
        const double t = length2 > 0 ? std::clamp((px * ux + py * uy) / length2, 0.0, 1.0) : 0.0;
        const double dx = px - t * ux, dy = py - t * uy;
        if (dx * dx + dy * dy >= distance2_) return;
        distance2_ = dx * dx + dy * dy;
        found_ = {0, {a[0] + t * ux, a[1] + t * uy}, outline};
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

/// Squared distances of p from the nearest and the farthest place of a box.
std::pair<double, double> distances2(const Point2& p, const Point2& low, const Point2& high) {
    double nearest2 = 0, farthest2 = 0;
    for (const std::size_t axis : {0u, 1u}) {
        const double below = low[axis] - p[axis], above = p[axis] - high[axis];
        const double nearest = std::max({below, above, 0.0}), farthest = std::max(-below, -above);
        nearest2 += nearest * nearest;
        farthest2 += farthest * farthest;
    }
    return {nearest2, farthest2};
}

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

bool Section::contains(const Point2& p) const {
    int layers = 0;
    for (std::size_t o = 0; o < outlines.size(); ++o)
        if (is_inside(outlines[o], p)) layers += layer(o);
    return layers > 0;
}

Section::Nearest Section::nearest(const Point2& p) const {
    NearestPoint nearest(p);
    for (std::size_t o = 0; o < outlines.size(); ++o)
        for_each_edge(outlines[o], [&](const Point2& a, const Point2& b) { nearest.look_at(a, b, o); });
    return nearest.found();
}

SectionSearch::SectionSearch(const Section& section) : section_(section) {
    for (std::size_t o = 0; o < section.outlines.size(); ++o) {
        const Polygon2& outline = section.outlines[o];
        for (std::size_t begin = 0; begin < outline.size(); begin += kStretchEdges) {
            Stretch stretch{o, begin, std::min(begin + kStretchEdges, outline.size()), before(outline, begin),
                            before(outline, begin)};
            for (std::size_t i = begin; i < stretch.end; ++i)
                for (const std::size_t axis : {0u, 1u}) {
                    stretch.low[axis] = std::min(stretch.low[axis], outline[i][axis]);
                    stretch.high[axis] = std::max(stretch.high[axis], outline[i][axis]);
                }
            stretches_.push_back(stretch);
        }
    }
}

bool SectionSearch::contains(const Point2& p) const {
    int layers = 0;
    bool inside = false;  // of the outline whose stretches are looked at
    for (std::size_t s = 0; s < stretches_.size(); ++s) {
        const Stretch& stretch = stretches_[s];
        if (stretch.begin == 0) inside = false;
        if (stretch.low[1] <= p[1] && stretch.high[1] > p[1]) {  // else no edge goes from one side to the other
            const Polygon2& outline = section_.outlines[stretch.outline];
            for (std::size_t i = stretch.begin; i < stretch.end; ++i)
                inside ^= passes_right_of(p, before(outline, i), outline[i]);
        }
        const bool is_last = s + 1 == stretches_.size() || stretches_[s + 1].begin == 0;
        if (is_last && inside) layers += section_.layer(stretch.outline);
    }
    return layers > 0;
}

Section::Nearest SectionSearch::nearest(const Point2& p) const {
    // Bounds are compared with room for their rounding.
    constexpr double kLess = 1 - 1e-12, kMore = 1 + 1e-12;
    double limit2 = std::numeric_limits<double>::infinity();
    for (const Stretch& stretch : stretches_) limit2 = std::min(limit2, distances2(p, stretch.low, stretch.high).second);
    NearestPoint nearest(p);
    for (const Stretch& stretch : stretches_) {
        if (kLess * distances2(p, stretch.low, stretch.high).first > std::min(kMore * limit2, nearest.distance2())) continue;
        const Polygon2& outline = section_.outlines[stretch.outline];
        for (std::size_t i = stretch.begin; i < stretch.end; ++i)
            nearest.look_at(before(outline, i), outline[i], stretch.outline);
    }
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

DrawnPlanes::DrawnPlanes(const ContourSet& drawn)
    : set(drawn),
      ball(smallest_ball(drawn)),
      tolerance_mm(1.5e-3 * ball.diameter()),
      sections(sections_of(drawn, kSamePlane * ball.diameter())) {}

std::optional<DrawnPlanes::Next> DrawnPlanes::next(const Plane& plane, double sign) const {
    std::optional<Next> nearest;
    for (const Section& other : sections) {
        const double ahead = sign * plane.distance_to(other.plane.origin);
        if (are_parallel(plane, other.plane) && ahead > tolerance_mm && (!nearest || ahead < nearest->distance_mm))
            nearest = Next{&other, ahead};
    }
    return nearest;
}

}  // namespace kontur
