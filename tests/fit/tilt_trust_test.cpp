// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/tilt_trust.h"

#include <gtest/gtest.h>

#include <numeric>
#include <span>

#include "kontur/fit/fit.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

constexpr double kScale = 0.5, kTilt = 0.5;

/// A ring of radius 20 whose sides turn by +-`turn` every 4 mm.
Contour zigzag(const Plane& plane, double turn) {
    Contour ring = test::circle(plane, 20, 32);
    const double height = distance(ring.points[0], ring.points[1]) * std::tan(turn);
    for (std::size_t i = 0; i < ring.points.size(); i += 2) {
        const Vec3 outward = normalized(ring.points[i] - plane.origin);
        ring.points[i] += height * outward;
    }
    return ring;
}

std::vector<BoundaryPoint> points_of(const ContourSet& set) {
    return prepare(set, {.least_segments = 400, .bounds = false}).points;
}

/// What is believed where a fit shows the same tilt everywhere.
std::vector<double> believed(const std::vector<BoundaryPoint>& points, double scale_mm = kScale) {
    std::vector<std::size_t> all(points.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return believed_slopes(points, all, std::vector<double>(points.size(), std::cos(kTilt)), scale_mm);
}

/// Mean share of the tilt that is believed, over the first contour.
double share(const std::vector<BoundaryPoint>& points, double scale_mm = kScale) {
    const std::vector<double> slopes = believed(points, scale_mm);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < points.size() && points[i].contour == 0; ++i, ++count) sum += std::acos(slopes[i]);
    return sum / count / kTilt;
}

ContourSet stack(double turn, double gap_mm) {
    ContourSet set;
    for (const double z : {0.0, gap_mm, -gap_mm}) set.contours.push_back(zigzag(make_plane({0, 0, z}, {0, 0, 1}), turn));
    return set;
}

TEST(LineTurns, OfACircleAreForetoldFromAnyDistance) {
    ContourSet set;
    set.contours = {test::circle(make_plane({}, {0, 0, 1}), 20, 60)};
    const LineTurns turns(points_of(set), kScale);
    for (const double distance : {0.1, 2.0, 10.0, 1000.0}) EXPECT_LT(turns.square_at(distance), 1e-3) << distance;
}

TEST(LineTurns, OfAZigzagAreItsAngleFromMoreThanASideAway) {
    for (const double turn : {0.2, 0.4}) {
        const LineTurns turns(points_of(stack(turn, 50)), 0.1);
        EXPECT_LT(turns.square_at(0.2), 0.2 * turn * turn) << "along one side";
        EXPECT_NEAR(std::sqrt(turns.square_at(20)), turn, 0.15 * turn);
    }
}

TEST(LineTurns, OfAnOpenLineEndAtItsEnds) {
    Contour half = test::circle(make_plane({}, {0, 0, 1}), 20, 200);
    half.points.resize(100);
    std::vector<BoundaryPoint> points;
    for (const Vec3& p : half.points) points.push_back({.position = p});
    EXPECT_LT(LineTurns(points, kScale).square_at(12), 1e-3) << "no chord runs from one end to the other";
}

TEST(TiltTrust, OfSmoothLinesIsWhole) { EXPECT_GT(share(points_of(test::ball_slices({}, 20, 2, 4))), 0.99); }

TEST(TiltTrust, OfRoughLinesFallsWithTheDistanceOfOtherPlanes) {
    double before = 1;
    for (const double gap : {1.0, 2.0, 4.0, 8.0}) {
        const double now = share(points_of(stack(0.4, gap)));
        EXPECT_LT(now, before) << gap;
        before = now;
    }
    EXPECT_NEAR(before, 1 - 0.4 * 0.4 / (kTilt * kTilt), 0.15) << "what is left of it far away";
    EXPECT_LT(share(points_of(stack(0.6, 8))), 0.1) << "lines that turn by more than the surface seems to be tilted";
}

TEST(TiltTrust, IsWholeWhereAPlaneOfAnotherDirectionCrosses) {
    ContourSet set = stack(0.4, 30);
    set.contours.push_back(test::circle(make_plane({}, {1, 0, 0}), 20, 60));
    const std::vector<BoundaryPoint> points = points_of(set);
    const std::vector<double> slopes = believed(points);
    for (std::size_t i = 0; points[i].contour == 0; ++i) {
        const double away = std::abs(points[i].position.x), tilt = std::acos(slopes[i]) / kTilt;
        if (away < 0.5) {
            EXPECT_GT(tilt, 0.85);
        } else if (away > 15) {
            EXPECT_LT(tilt, 0.65);  // the smooth line counts as well
        }
    }
}

TEST(TiltTrust, TurnsMovesAndScalesWithTheDrawing) {
    const std::vector<BoundaryPoint> points = points_of(stack(0.4, 4));
    std::vector<BoundaryPoint> moved = points;
    const auto turned = [](const Vec3& v) { return Vec3{v.z, 0.6 * v.x + 0.8 * v.y, -0.8 * v.x + 0.6 * v.y}; };
    for (BoundaryPoint& p : moved) {
        p.position = 3 * turned(p.position) + Vec3{100, -50, 20};
        p.plane_normal = turned(p.plane_normal);
    }
    EXPECT_NEAR(share(moved, 3 * kScale), share(points), 1e-6);
}

TEST(TiltTrust, APlaneThatComesNearMakesNoLeap) {
    const double alone = share(points_of(stack(0.4, 8)));
    double before = alone;
    for (double gap = 0.02; gap < 8; gap *= 1.05) {
        ContourSet set = stack(0.4, 8);
        set.contours.push_back(zigzag(make_plane({0, 0, gap}, {0, 0, 1}), 0.4));
        const double now = share(points_of(set));
        if (gap < 0.03) {
            EXPECT_NEAR(now, alone, 1e-9) << "drawn twice, " << gap << " mm off";
        }
        EXPECT_NEAR(now, before, 0.06) << gap;
        before = now;
    }
}

TEST(TiltTrust, IsTheSameForPointsInBetweenAsForThoseThatAreLookedAt) {
    const std::vector<BoundaryPoint> points = points_of(stack(0.4, 4));
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (i % 5 == 0 || points[i].contour != points[i - 1].contour) some.push_back(i);
    const std::vector<double> of_all = believed(points);
    const std::vector<double> of_some =
        believed_slopes(points, some, std::vector<double>(points.size(), std::cos(kTilt)), kScale);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(of_some[i], of_all[i], 0.02) << i;
}

TEST(TiltTrust, SinglePointsAndPointsThatCoincideHaveNone) {
    const std::vector<BoundaryPoint> points(5, {.position = {1, 2, 3}, .plane_normal = {}, .contour = kNoContour});
    for (const double slope : believed(points)) {
        EXPECT_GE(slope, std::cos(kTilt));
        EXPECT_LE(slope, 1);
    }
}

}  // namespace
}  // namespace kontur
