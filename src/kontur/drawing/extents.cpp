// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/extents.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kontur/base/smooth_step.h"

namespace kontur {
namespace {

constexpr double kOne = 2, kTwo = 3.5;      // radii of the larger of two, between which lies one part, and two
constexpr double kLone = 35, kLonely = 50;  // the same for a single contour
constexpr double kNear = 3;                 // mm per mm by which what a part shows fades out beside it
constexpr double kLeast = 0.02;  // a half and a quarter mask small balls alike, a twentieth makes the system singular

double gap_mm(const Ball3& a, const Ball3& b) { return std::max(0.0, distance(a.center, b.center) - a.radius - b.radius); }

Ball3 around(const Ball3& a, const Ball3& b) {
    const double apart = distance(a.center, b.center);
    if (apart + b.radius <= a.radius) return a;
    if (apart + a.radius <= b.radius) return b;
    const double radius = (apart + a.radius + b.radius) / 2;
    return {a.center + (radius - a.radius) / apart * (b.center - a.center), radius};
}

struct Link {
    std::size_t from, to;
    double gap_mm;
};

/// The shortest links that join all (Prim), the shortest first.
std::vector<Link> shortest_links(const std::vector<Ball3>& balls) {
    std::vector<Link> links, nearest;
    for (std::size_t c = 1; c < balls.size(); ++c) nearest.push_back({0, c, gap_mm(balls[0], balls[c])});
    while (!nearest.empty()) {
        const auto next = std::ranges::min_element(nearest, {}, &Link::gap_mm);
        const std::size_t contour = next->to;
        links.push_back(*next);
        *next = nearest.back();
        nearest.pop_back();
        for (Link& link : nearest)
            if (const double gap = gap_mm(balls[contour], balls[link.to]); gap < link.gap_mm) link = {contour, link.to, gap};
    }
    std::ranges::stable_sort(links, {}, &Link::gap_mm);
    return links;
}

/// What has been joined so far.
struct Part {
    std::vector<std::size_t> contours;
    Ball3 ball;
    double bond = 1;  ///< how surely it is one part
};

double bond_of(const Part& a, const Part& b, double gap_mm) {
    const bool is_lone = a.contours.size() == 1 || b.contours.size() == 1;
    const double ratio = gap_mm / std::max(std::max(a.ball.radius, b.ball.radius), 1e-300);
    return 1 - (is_lone ? smooth_step(kLone, kLonely, ratio) : smooth_step(kOne, kTwo, ratio));
}

Ball3 exact_ball(const ContourSet& set, const std::vector<std::size_t>& contours) {
    std::vector<Vec3> points;
    for (const std::size_t c : contours)
        points.insert(points.end(), set.contours[c].points.begin(), set.contours[c].points.end());
    return smallest_ball(points);
}

}  // namespace

Extents::Extents(const ContourSet& set, const Ball3& ball) : whole_mm_(ball.radius) {
    for (const Contour& contour : set.contours) contours_.push_back(smallest_ball(contour.points));
    part_mm_.resize(contours_.size(), whole_mm_);
    if (!contours_.empty()) join(set);
    is_one_part_ = std::ranges::all_of(part_mm_, [&](double mm) { return mm >= whole_mm_; });
}

void Extents::set_part(const std::vector<std::size_t>& contours, double radius_mm) {
    for (const std::size_t c : contours) part_mm_[c] = radius_mm;
}

void Extents::join(const ContourSet& set) {
    std::vector<Part> all;
    std::vector<std::size_t> of(contours_.size());
    for (std::size_t c = 0; c < contours_.size(); ++c) {
        all.push_back({{c}, contours_[c]});
        of[c] = c;
    }
    bool is_whole = true;
    for (const Link& link : shortest_links(contours_)) {
        Part &one = all[of[link.from]], &other = all[of[link.to]];
        const double bond = bond_of(one, other, link.gap_mm) * std::min(one.bond, other.bond);
        is_whole = is_whole && bond == 1;
        if (bond == 0) continue;
        if (bond < 1)
            for (const Part* part : {&one, &other})
                if (part->bond == 1) set_part(part->contours, exact_ball(set, part->contours).radius);
        const std::size_t index = of[link.from];
        for (const std::size_t c : other.contours) of[c] = index;
        one.contours.insert(one.contours.end(), other.contours.begin(), other.contours.end());
        other.contours.clear();
        one.ball = around(one.ball, other.ball);
        one.bond = bond;
        if (bond == 1) continue;
        const double radius = exact_ball(set, one.contours).radius;
        for (const std::size_t c : one.contours) part_mm_[c] = std::lerp(part_mm_[c], radius, bond);
    }
    for (Part& one : all) {
        if (one.contours.empty()) continue;
        std::ranges::sort(one.contours);
        if (one.bond == 1) set_part(one.contours, is_whole ? whole_mm_ : exact_ball(set, one.contours).radius);
        parts_.push_back(std::move(one.contours));
    }
    std::ranges::sort(parts_, {}, [](const std::vector<std::size_t>& part) { return part.front(); });
}

double Extents::at(const Vec3& place) const {
    if (is_one_part_) return 1;
    double nearest = whole_mm_, of_parts = 0;
    for (std::size_t c = 0; c < contours_.size(); ++c) {
        const double apart = std::max(0.0, distance(contours_[c].center, place) - contours_[c].radius);
        nearest = std::min(nearest, apart);
        of_parts = std::max(of_parts, part_mm_[c] - apart / kNear);
    }
    return std::clamp(std::max(of_parts, nearest) / whole_mm_, kLeast, 1.0);
}

}  // namespace kontur
