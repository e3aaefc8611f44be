// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/tidy.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/polygons.h"
#include "support/random.h"

namespace kontur {
namespace {

using test::Point2;

const Plane kTilted = make_plane({30, -20, 100}, {0.3, -0.5, 0.8});

std::vector<Vec3> tidied(Contour contour, const TidyOptions& options = {}) {
    ContourSet set;
    set.contours = {std::move(contour)};
    tidy(set, options);
    return set.contours.front().points;
}

Contour polygon(const std::vector<Point2>& points) { return test::contour_in(kTilted, points); }

TEST(Tidy, TakesOutSpikesAndNothingElse) {
    const Contour square = polygon({{0, 0}, {10, 0}, {10, 10}, {0, 10}});
    EXPECT_EQ(tidied(square), square.points);
    EXPECT_EQ(tidied(polygon({{0, 0}, {10, 0}, {10, 10}, {10, 14}, {10, 10}, {0, 10}})), square.points) << "a needle";
    EXPECT_EQ(tidied(polygon({{0, 0}, {10, 0}, {13, 2}, {17, 1}, {13, 2}, {10, 0}, {10, 10}, {0, 10}})), square.points)
        << "a bent needle";
    EXPECT_EQ(tidied(polygon({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {-3, -4}})), square.points) << "at the seam";
    EXPECT_EQ(tidied(polygon({{-3, -4}, {0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}})), square.points) << "first of all";
    const Contour narrow = polygon({{0, 0}, {10, 0}, {10, 10}, {10.2, 14}, {9.9, 10}, {0, 10}});
    EXPECT_EQ(tidied(narrow), narrow.points) << "it encloses something";
}

TEST(Tidy, RefusesAContourThatIsNothingButASpike) {
    ContourSet set;
    set.contours = {polygon({{0, 0}, {10, 0}, {10, 10}}), polygon({{0, 0}, {5, 1}, {9, 7}, {5, 1}})};
    EXPECT_KONTUR_ERROR(tidy(set), ErrorKind::invalid_input, "contour 2 is nothing but a path back along itself");
}

TEST(Tidy, OpenContoursKeepTheirEnds) {
    Contour stretch = polygon({{0, 0}, {10, 0}, {14, 3}, {10, 0}, {20, 0}, {20, 9}});
    stretch.closed = false;
    const std::vector<Vec3> kept = tidied(stretch);
    EXPECT_EQ(kept.front(), stretch.points.front());
    EXPECT_EQ(kept.back(), stretch.points.back());
    EXPECT_EQ(kept.size(), 4u);
}

/// Largest distance of the points from a polygon.
double farthest(const std::vector<Vec3>& points, const std::vector<Vec3>& polygon) {
    double worst = 0;
    for (const Vec3& p : points) {
        double nearest = 1e300;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const auto flat = [&](const Vec3& q) { return kTilted.to_uv(q); };
            nearest = std::min(
                nearest, test::distance_to_segment(flat(polygon[i]), flat(polygon[(i + 1) % polygon.size()]), flat(p)));
        }
        worst = std::max(worst, nearest);
    }
    return worst;
}

TEST(Tidy, ThinsHugeContoursWithinTheDistanceThatItStates) {
    std::mt19937 random = test::random_of_this_test();
    std::normal_distribution<double> jitter(0, 0.05);
    for (const double noise : {0.0, 1.0}) {
        Contour huge = test::circle(kTilted, 40, 20000);
        for (Vec3& p : huge.points) p += noise * (jitter(random) * kTilted.u + jitter(random) * kTilted.v);
        ContourSet set;
        set.contours = {huge, test::circle(kTilted, 10, 900)};
        const TidyReport done = tidy(set, {.spike_tolerance_mm = 0});
        const std::vector<Vec3>& kept = set.contours[0].points;
        EXPECT_LE(kept.size(), 1000u);
        EXPECT_EQ(set.contours[1].points.size(), 900u) << "few enough";
        EXPECT_EQ(done.thinned_contours, 1u);
        EXPECT_EQ(done.thinned_points, 20000 - kept.size());
        EXPECT_LE(farthest(huge.points, kept), done.thinned_mm + 1e-9);
        EXPECT_LT(done.thinned_mm, noise > 0 ? 0.3 : 0.0101);
    }
}

TEST(Tidy, ThinsARingToTheSamePointsHoweverItIsStored) {
    std::mt19937 random = test::random_of_this_test();
    std::normal_distribution<double> jitter(0, 0.05);
    Contour huge = test::circle(kTilted, 40, 5000);
    for (Vec3& p : huge.points) p += jitter(random) * kTilted.u + jitter(random) * kTilted.v;
    const std::vector<Vec3> kept = tidied(huge);
    EXPECT_LE(kept.size(), 1000u);
    for (const int later : {1, 1700, 4999}) {
        Contour other = huge;
        std::ranges::rotate(other.points, other.points.begin() + later);
        EXPECT_EQ(tidied(other), kept);
        std::ranges::reverse(other.points);
        EXPECT_EQ(tidied(other), kept);
    }
}

TEST(Tidy, AHundredThousandPointsAndTheirCornersAreNoTrouble) {
    Contour square = polygon({{0, 0}, {30, 0}, {30, 30}, {0, 30}});
    std::vector<Vec3> fine;
    for (std::size_t side = 0; side < 4; ++side)
        for (int i = 0; i < 25000; ++i)
            fine.push_back(square.points[side] + (i / 25000.0) * (square.points[(side + 1) % 4] - square.points[side]));
    const std::vector<Vec3> corners = square.points;
    square.points = fine;
    const std::vector<Vec3> kept = tidied(square);
    EXPECT_LT(kept.size(), 10u);
    for (const Vec3& corner : corners) EXPECT_TRUE(std::ranges::count(kept, corner)) << "a corner is lost";
}

}  // namespace
}  // namespace kontur
