// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/geometry/uniform_spline.h"

#include <algorithm>
#include <cmath>

namespace kontur {
namespace {

constexpr int kMostSteps = 10;

/// Solves x[i-1] + diagonal[i] x[i] + x[i+1] = right[i] without a corner (Thomas).
template <class Value>
std::vector<Value> solve_tridiagonal(std::vector<double> diagonal, std::vector<Value> right) {
    const std::size_t count = right.size();
    for (std::size_t i = 1; i < count; ++i) {
        const double factor = 1 / diagonal[i - 1];
        diagonal[i] -= factor;
        right[i] = right[i] - factor * right[i - 1];
    }
    right[count - 1] = (1 / diagonal[count - 1]) * right[count - 1];
    for (std::size_t i = count - 1; i-- > 0;) right[i] = (1 / diagonal[i]) * (right[i] - right[i + 1]);
    return right;
}

/// The corners of the periodic system are taken in by Sherman and Morrison's formula.
std::vector<Vec3> slopes_of_closed(std::span<const Vec3> points) {
    const std::size_t count = points.size();
    std::vector<Vec3> right(count);
    for (std::size_t i = 0; i < count; ++i) right[i] = 3.0 * (points[(i + 1) % count] - points[(i + count - 1) % count]);
    constexpr double kDiagonal = 4, kCorner = -kDiagonal;
    std::vector<double> diagonal(count, kDiagonal), column(count, 0.0);
    diagonal.front() -= kCorner;
    diagonal.back() -= 1 / kCorner;
    column.front() = kCorner;
    column.back() = 1;
    std::vector<Vec3> slopes = solve_tridiagonal(diagonal, std::move(right));
    const std::vector<double> correction = solve_tridiagonal(diagonal, std::move(column));
    const Vec3 share = (slopes.front() + slopes.back() / kCorner) / (1 + correction.front() + correction.back() / kCorner);
    for (std::size_t i = 0; i < count; ++i) slopes[i] -= correction[i] * share;
    return slopes;
}

std::vector<Vec3> slopes_of_open(std::span<const Vec3> points) {
    const std::size_t inner = points.size() - 2;
    std::vector<Vec3> right(inner);
    for (std::size_t i = 0; i < inner; ++i) right[i] = 3.0 * (points[i + 2] - points[i]);
    std::vector<Vec3> slopes = solve_tridiagonal(std::vector<double>(inner, 4.0), std::move(right));
    slopes.insert(slopes.begin(), Vec3{});
    slopes.emplace_back();
    return slopes;
}

struct Stretch {
    Vec3 from, to, from_slope, to_slope;

    Vec3 at(double t) const {
        const double s = 1 - t;
        return s * s * (1 + 2 * t) * from + t * t * (3 - 2 * t) * to + s * s * t * from_slope - s * t * t * to_slope;
    }

    double off_chord() const {
        double off = 0;
        for (int i = 1; i < kMostSteps; ++i) off = std::max(off, distance_to_segment(at(double(i) / kMostSteps), from, to));
        return off;
    }
};

/// The distance of a curve from its chords falls with the square of their number.
int steps_for(double off_mm, double tolerance_mm) {
    if (!(off_mm > tolerance_mm)) return 1;
    return static_cast<int>(std::min(double{kMostSteps}, std::ceil(std::sqrt(off_mm / tolerance_mm))));
}

}  // namespace

UniformSpline uniform_spline(std::span<const Vec3> points, bool closed, double tolerance_mm) {
    const std::size_t count = points.size();
    if (count < 3) return {{points.begin(), points.end()}};
    const std::vector<Vec3> slopes = closed ? slopes_of_closed(points) : slopes_of_open(points);
    UniformSpline spline;
    for (std::size_t i = 0; i < (closed ? count : count - 1); ++i) {
        const std::size_t next = (i + 1) % count;
        const Stretch stretch{points[i], points[next], slopes[i], slopes[next]};
        const double off_mm = stretch.off_chord();
        const int steps = steps_for(off_mm, tolerance_mm);
        if (steps > 1) spline.off_mm = std::max(spline.off_mm, off_mm);
        spline.points.push_back(points[i]);
        for (int k = 1; k < steps; ++k) spline.points.push_back(stretch.at(double(k) / steps));
    }
    if (!closed) spline.points.push_back(points.back());
    return spline;
}

}  // namespace kontur
