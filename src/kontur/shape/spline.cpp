// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/spline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "kontur/base/error.h"

namespace kontur {
namespace {

constexpr int kMostSteps = 1000;

/// Barry and Goldman's pyramid: the curve at parameter `t` by repeated linear interpolation between the knots.
Vec3 evaluate(const std::array<Vec3, 4>& p, const std::array<double, 4>& knots, double t) {
    const auto blend = [&](const Vec3& a, const Vec3& b, int i, int j) {
        return ((knots[j] - t) * a + (t - knots[i]) * b) / (knots[j] - knots[i]);
    };
    const Vec3 a1 = blend(p[0], p[1], 0, 1), a2 = blend(p[1], p[2], 1, 2), a3 = blend(p[2], p[3], 2, 3);
    return blend(blend(a1, a2, 0, 2), blend(a2, a3, 1, 3), 1, 2);
}

}  // namespace

std::vector<Vec3> spline_stretch(const Vec3& before, const Vec3& from, const Vec3& to, const Vec3& after, double step_mm) {
    if (!(step_mm > 0))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the step of a spline is {:g} mm; it must be greater than 0", step_mm));
    if (from == to) return {};
    const std::array<Vec3, 4> p{before == from ? 2.0 * from - to : before, from, to, after == to ? 2.0 * to - from : after};
    std::array<double, 4> knots{};
    for (int i = 1; i < 4; ++i) knots[i] = knots[i - 1] + std::sqrt(distance(p[i - 1], p[i]));
    const int steps = static_cast<int>(std::clamp(std::ceil(distance(from, to) / step_mm), 1.0, double{kMostSteps}));
    std::vector<Vec3> points{from};
    for (int i = 1; i < steps; ++i) points.push_back(evaluate(p, knots, knots[1] + (knots[2] - knots[1]) * i / steps));
    return points;
}

std::vector<Vec3> spline(std::span<const Vec3> points, bool closed, double step_mm) {
    const std::size_t count = points.size();
    if (count < 3) return {points.begin(), points.end()};
    // An open curve's ends have no neighbour: the point itself stands in, which spline_stretch mirrors.
    const auto at = [&](std::size_t i, std::ptrdiff_t step) -> const Vec3& {
        if (closed) return points[(i + count + step) % count];
        return points[static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(std::ptrdiff_t(i) + step, 0, std::ptrdiff_t(count) - 1))];
    };
    std::vector<Vec3> curve;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
        const std::vector<Vec3> stretch = spline_stretch(at(i, -1), at(i, 0), at(i, 1), at(i, 2), step_mm);
        curve.insert(curve.end(), stretch.begin(), stretch.end());
    }
    if (!closed) curve.push_back(points.back());
    return curve;
}

}  // namespace kontur
