// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/smallest_ball.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace kontur {
namespace {

constexpr double kSlack = 1e-12;  // of the radius: points so far outside count as on the ball

/// The smallest ball with all of at most four points on its surface; nullopt when they lie on a line or circle.
std::optional<Ball3> ball_through(std::span<const Vec3> points) {
    // The centre is points[0] + sum s_k e_k with e_k = points[k + 1] - points[0] and e_j . sum s_k e_k = e_j . e_j / 2.
    const std::size_t n = points.size() - 1;
    std::array<Vec3, 3> edge;
    std::array<std::array<double, 4>, 3> rows{};
    for (std::size_t j = 0; j < n; ++j) edge[j] = points[j + 1] - points[0];
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < n; ++k) rows[j][k] = dot(edge[j], edge[k]);
        rows[j][3] = rows[j][j] / 2;
    }
    for (std::size_t j = 0; j < n; ++j) {
        const double own = dot(edge[j], edge[j]);
        if (!(rows[j][j] > 1e-12 * own)) return std::nullopt;  // what is left of the edge lies in the span of those before
        for (std::size_t below = j + 1; below < n; ++below) {
            const double factor = rows[below][j] / rows[j][j];
            for (std::size_t k = j; k < 4; ++k) rows[below][k] -= factor * rows[j][k];
        }
    }
    Vec3 to_center;
    std::array<double, 3> s{};
    for (std::size_t j = n; j-- > 0;) {
        double rest = rows[j][3];
        for (std::size_t k = j + 1; k < n; ++k) rest -= rows[j][k] * s[k];
        s[j] = rest / rows[j][j];
        to_center += s[j] * edge[j];
    }
    return Ball3{points[0] + to_center, norm(to_center)};
}

bool contains(const Ball3& ball, const Vec3& p) { return distance(ball.center, p) <= (1 + kSlack) * ball.radius; }

const Vec3& farthest_from(const Vec3& center, std::span<const Vec3> points) {
    const Vec3* farthest = &points.front();
    double farthest2 = 0;
    for (const Vec3& p : points)
        if (const double distance2 = dot(p - center, p - center); distance2 > farthest2) {
            farthest = &p;
            farthest2 = distance2;
        }
    return *farthest;
}

/// What holds a ball: points on its surface.
struct SupportedBall {
    Ball3 ball;
    std::vector<Vec3> support;
};

/// The smallest ball around a support and one point outside of its ball, which will be on the new one's surface.
SupportedBall hold(const std::vector<Vec3>& support, const Vec3& outside) {
    SupportedBall best;
    for (unsigned subset = 0; subset < 1U << support.size(); ++subset) {
        std::vector<Vec3> corners{outside};
        for (std::size_t i = 0; i < support.size(); ++i)
            if (subset >> i & 1U) corners.push_back(support[i]);
        if (corners.size() > 4) continue;
        const std::optional<Ball3> ball = ball_through(corners);
        if (!ball || (!best.support.empty() && ball->radius >= best.ball.radius)) continue;
        if (std::all_of(support.begin(), support.end(), [&](const Vec3& p) { return contains(*ball, p); }))
            best = {*ball, corners};
    }
    return best;
}

}  // namespace

Ball3 smallest_ball(std::span<const Vec3> points) {
    constexpr int kMostPasses = 1000;  // far more than needed: each pass makes the ball grow
    if (points.empty()) return {};
    // From one of the points: far from the origin the centre would be rounded more than the slack allows.
    const Vec3 origin = points[0];
    std::vector<Vec3> from_origin(points.size());
    std::transform(points.begin(), points.end(), from_origin.begin(), [&](const Vec3& p) { return p - origin; });
    SupportedBall current{{{}, 0}, {{}}};
    for (int pass = 0; pass < kMostPasses; ++pass) {
        const Vec3& farthest = farthest_from(current.ball.center, from_origin);
        if (contains(current.ball, farthest)) break;
        SupportedBall grown = hold(current.support, farthest);
        if (!(grown.ball.radius > current.ball.radius)) {  // rounding
            current.ball.radius = distance(current.ball.center, farthest);
            break;
        }
        current = std::move(grown);
    }
    return {origin + current.ball.center, current.ball.radius};
}

}  // namespace kontur
