// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/orient.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

namespace kontur {
namespace {

using Point2 = std::array<double, 2>;

/// A closed polygon in the contour's plane; segment i runs from point i to point i + 1. Questions of side are answered on
/// coordinates rounded to integers, so exactly, and ties are broken by an infinitesimal displacement of every point that
/// depends on its index alone (Edelsbrunner & Muecke 1990). Thus no three points are ever in line, and all answers agree
/// with one another: pixel-snapped contours do run through their own vertices and along their own segments.
class Polygon {
public:
    explicit Polygon(const Contour& contour) {
        for (const Vec3& p : contour.points) points_.push_back(contour.plane.to_uv(p));
        Point2 low = points_.front(), high = low;
        for (const Point2& p : points_)
            for (std::size_t axis = 0; axis < 2; ++axis) {
                low[axis] = std::min(low[axis], p[axis]);
                high[axis] = std::max(high[axis], p[axis]);
            }
        const double extent = std::max({high[0] - low[0], high[1] - low[1], 1e-300});
        const auto round = [&](double v) { return std::llround(v / extent * kSteps); };
        for (const Point2& p : points_) rounded_.push_back({round(p[0] - low[0]), round(p[1] - low[1])});
    }

    std::size_t size() const { return points_.size(); }
    std::size_t after(std::size_t i) const { return i + 1 < size() ? i + 1 : 0; }
    std::size_t before(std::size_t i) const { return i > 0 ? i - 1 : size() - 1; }
    const Point2& point(std::size_t i) const { return points_[i]; }
    Point2 edge(std::size_t i) const {
        const Point2 &from = points_[i], &to = points_[after(i)];
        return {to[0] - from[0], to[1] - from[1]};
    }

    /// The rounded first coordinate.
    std::int64_t column(std::size_t i) const { return rounded_[i][0]; }

    /// Twice the signed area of three points on the rounded coordinates.
    std::int64_t area(std::size_t a, std::size_t b, std::size_t c) const {
        const auto &p = rounded_[a], &q = rounded_[b], &r = rounded_[c];
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    }

    /// Whether three different points make a left turn; never a tie.
    bool is_left_turn(std::size_t a, std::size_t b, std::size_t c) const {
        bool even = true;  // a permutation that sorts them by index
        const auto sort = [&](std::size_t& first, std::size_t& second) {
            if (first < second) return;
            std::swap(first, second);
            even = !even;
        };
        sort(a, b);
        sort(b, c);
        sort(a, b);
        const auto &p = rounded_[a], &q = rounded_[b], &r = rounded_[c];
        // The area's terms in order of falling size when y_a, x_a, y_b, ... grow by ever smaller amounts.
        for (const std::int64_t term : {area(a, b, c), r[0] - q[0], q[1] - r[1], p[0] - r[0]})
            if (term != 0) return (term > 0) == even;
        return even;
    }

    /// The point of smallest first coordinate, after that displacement; surely a convex corner.
    std::size_t extreme_point() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < size(); ++i)
            if (rounded_[i][0] <= rounded_[best][0]) best = i;
        return best;
    }

private:
    static constexpr double kSteps = 1 << 26;  // products of two differences fit 64 bits with room to spare

    std::vector<Point2> points_;
    std::vector<std::array<std::int64_t, 2>> rounded_;
};

bool segments_cross(const Polygon& polygon, std::size_t i, std::size_t j) {
    const std::size_t a = i, b = polygon.after(i), c = j, d = polygon.after(j);
    return polygon.is_left_turn(a, b, c) != polygon.is_left_turn(a, b, d) &&
           polygon.is_left_turn(c, d, a) != polygon.is_left_turn(c, d, b);
}

/// Where segment i meets the line of segment j.
Point2 crossing_point(const Polygon& polygon, std::size_t i, std::size_t j) {
    const auto from = static_cast<double>(polygon.area(j, polygon.after(j), i));
    const auto to = static_cast<double>(polygon.area(j, polygon.after(j), polygon.after(i)));
    const double t = from != to ? std::clamp(from / (from - to), 0.0, 1.0) : 0.0;
    const Point2 &p = polygon.point(i), edge = polygon.edge(i);
    return {p[0] + t * edge[0], p[1] + t * edge[1]};
}

struct Crossings {
    std::vector<int> count;  ///< per segment: how many other segments cross it
    std::vector<Point2> points;
};

/// All crossings of segments without a common end, by a sweep over the first coordinate.
Crossings find_crossings(const Polygon& polygon) {
    const std::size_t n = polygon.size();
    const auto low = [&](std::size_t i) { return std::min(polygon.column(i), polygon.column(polygon.after(i))); };
    const auto high = [&](std::size_t i) { return std::max(polygon.column(i), polygon.column(polygon.after(i))); };
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });

    Crossings result{std::vector<int>(n, 0), {}};
    std::vector<std::size_t> active;
    for (const std::size_t i : order) {
        std::erase_if(active, [&](std::size_t j) { return high(j) < low(i); });
        for (const std::size_t j : active) {
            const bool adjacent = polygon.after(i) == j || polygon.after(j) == i;
            if (adjacent || !segments_cross(polygon, i, j)) continue;
            ++result.count[i];
            ++result.count[j];
            result.points.push_back(crossing_point(polygon, i, j));
        }
        active.push_back(i);
    }
    return result;
}

double length(const Point2& v) { return std::hypot(v[0], v[1]); }

/// Eq. 7 up to its sign: the left-hand normal of edge i - 1 plus that of edge i.
Point2 left_normal(const Polygon& polygon, std::size_t i) {
    const Point2 before = polygon.edge(polygon.before(i)), after = polygon.edge(i);
    const Point2 sum{-(before[1] + after[1]), before[0] + after[0]};
    const double total = length(before) + length(after);
    if (length(sum) > 1e-9 * total) return {sum[0] / length(sum), sum[1] / length(sum)};
    if (!(total > 0)) return {1, 0};
    // The path turns back on itself. What lies left of it lies ahead of the tip after a right turn, behind it after a left
    // one.
    const double ahead = polygon.is_left_turn(polygon.before(i), i, polygon.after(i)) ? -1 / total : 1 / total;
    return {ahead * (before[0] - after[0]), ahead * (before[1] - after[1])};
}

/// +1 where the left-hand normal leads out of the polygon at a convex corner, else -1.
int outward_sign(const Polygon& polygon, std::size_t convex) {
    return polygon.is_left_turn(polygon.before(convex), convex, polygon.after(convex)) ? -1 : 1;
}

}  // namespace

ContourOrientation orient(const Contour& contour) {
    const Polygon polygon(contour);
    const Crossings crossings = find_crossings(polygon);
    const std::size_t n = polygon.size(), start = polygon.extreme_point();

    ContourOrientation result;
    result.normals.resize(n);
    int sign = outward_sign(polygon, start) * (contour.hole ? -1 : 1);
    for (std::size_t step = 0; step < n; ++step) {
        const std::size_t i = (start + step) % n;
        const Point2 normal = left_normal(polygon, i);
        result.normals[i] = normalized(sign * (normal[0] * contour.plane.u + normal[1] * contour.plane.v));
        if (crossings.count[i] % 2 != 0) sign = -sign;
    }
    for (const Point2& p : crossings.points) result.crossings.push_back(contour.plane.from_uv(p[0], p[1]));
    return result;
}

}  // namespace kontur
