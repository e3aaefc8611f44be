// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/fill_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/contour_sets.h"

#include "kontur/shape/apply_fill_rule.h"

namespace kontur {
namespace {

const Plane kPlane = make_plane({3, -40, 200}, {0.3, -0.5, 0.8});

Contour circle(double radius, double u, double v) { return test::circle(kPlane, radius, u, v); }

TEST(ApplyFillRule, EveryOtherLayerIsAHoleUnlessDeclaredOtherwise) {
    ContourSet set{"", {circle(4, 1, 0), circle(20, 0, 0), circle(9, 2, 1), circle(3, 60, 0), circle(2, 1, 0)}, {}, {}, {}};
    set.contours[3].hole = true;  // a cavity whose outer wall was not drawn here
    const auto holes = [](const ContourSet& s) {
        std::vector<bool> flags;
        for (const Contour& contour : s.contours) flags.push_back(contour.hole);
        return flags;
    };
    ContourSet even_odd = set;
    const FillChanges changes = apply_fill_rule(even_odd, FillRule::even_odd);
    EXPECT_EQ(holes(even_odd), (std::vector<bool>{false, false, true, true, true}));
    EXPECT_EQ(changes.holes, 2u);
    EXPECT_EQ(changes.removed, 0u);

    set.contours[2].hole = true;
    ContourSet declared = set;  // the circle of radius 4 is an island in the hole, that of radius 2 lies inside it
    EXPECT_EQ(apply_fill_rule(declared, FillRule::declared).removed, 1u);
    EXPECT_EQ(holes(declared), (std::vector<bool>{false, false, true, true}));
    EXPECT_EQ(declared.contours[0].points, set.contours[0].points);
}

TEST(ApplyFillRule, NamesHolesAroundWhichNothingIsDrawn) {
    ContourSet set;
    set.contours = {circle(20, 0, 0), circle(4, 1, 0), circle(5, 40, 0), circle(2, 1, 0)};
    for (const std::size_t c : {1, 2, 3}) set.contours[c].hole = true;
    for (const FillRule rule : {FillRule::even_odd, FillRule::declared}) {
        ContourSet filled = set;
        EXPECT_EQ(apply_fill_rule(filled, rule).stray_holes, (std::vector<std::size_t>{2, 3})) << name(rule);
        EXPECT_EQ(apply_fill_rule(filled, rule).stray_holes, (std::vector<std::size_t>{2, 3})) << "done again";
    }
}

/// Circles about an axis, `height` along it.
Contour ring(double height, double radius) {
    Plane plane = kPlane;
    plane.origin += height * plane.normal;
    return test::circle(plane, radius, 60);
}

/// A section through the axis of a cylinder, which ends at so far on both sides.
Contour along_axis(double radius, double end) {
    Contour contour{make_plane(kPlane.origin, kPlane.u), {}, true, false};
    const Vec3 beside = cross(kPlane.normal, kPlane.u);
    for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        contour.points.push_back(kPlane.origin + end * u * kPlane.normal + radius * v * beside);
    return contour;
}

struct Read {
    std::vector<bool> holes;
    std::vector<NearLines> near;

    bool is_one(std::size_t pair = 0) const { return near.at(pair).is_one; }
};

Read read(std::vector<Contour> contours, FillRule rule = FillRule::even_odd) {
    ContourSet set;
    set.contours = std::move(contours);
    Read result;
    result.near = apply_fill_rule(set, rule).near_lines;
    for (const Contour& contour : set.contours) result.holes.push_back(contour.hole);
    ContourSet again = set;
    apply_fill_rule(again, rule);
    EXPECT_TRUE(std::ranges::equal(set.contours, again.contours, {}, &Contour::hole, &Contour::hole));
    return result;
}

/// Contour 1 drawn again, wider by so much, between planes before and behind it.
std::vector<Contour> drawn_again(double wider) { return {ring(-8, 19), ring(0, 20), ring(8, 19), ring(0, 20 + wider)}; }

TEST(NearLines, ALineDrawnAgainIsNoHoleWherePlanesOnBothSidesShowTheObject) {
    for (const double wider : {0.01, 0.1, 0.5, 2.0, 4.0}) {
        const Read twice = read(drawn_again(wider));
        EXPECT_EQ(twice.holes, std::vector<bool>(4, false)) << wider;
        ASSERT_EQ(twice.near.size(), 1u) << wider;
        EXPECT_TRUE(twice.is_one());
        EXPECT_NEAR(twice.near[0].apart_mm, wider, 0.02 * wider + 0.03);
    }
    EXPECT_EQ(read(drawn_again(6)).holes, (std::vector<bool>{false, true, false, false})) << "no near lines";
}

TEST(NearLines, ThatNothingElseTellsOfLeaveAWallWhichIsNamed) {
    std::vector<Contour> contours = drawn_again(0.5);
    contours.erase(contours.begin());  // nothing before it
    const Read last = read(contours);
    EXPECT_EQ(last.holes, (std::vector<bool>{true, false, false}));
    ASSERT_EQ(last.near.size(), 1u);
    EXPECT_FALSE(last.is_one());
    EXPECT_EQ(last.near[0].contour, 0u);
    EXPECT_EQ(last.near[0].other, 2u);
    EXPECT_TRUE(read({ring(0, 17), ring(0, 20)}).near.empty()) << "a wall that is not so thin";
}

/// Rings so high and so wide.
std::vector<Contour> stack(std::initializer_list<std::pair<double, double>> rings) {
    std::vector<Contour> contours;
    for (const auto& [height, radius] : rings) contours.push_back(ring(height, radius));
    return contours;
}

TEST(NearLines, AtTheLastPlaneOrInTwoBesideEachOtherAreOneBesideABodyThatIsThickerThanTheWall) {
    const Read last = read(stack({{-16, 18}, {-8, 19}, {0, 20}, {0, 20.5}}));
    EXPECT_EQ(last.holes, std::vector<bool>(4, false));
    EXPECT_TRUE(last.is_one());
    const Read two = read(stack({{-16, 18}, {-8, 19}, {0, 20}, {0, 20.5}, {8, 20}, {8, 20.4}, {16, 18}}));
    EXPECT_EQ(two.holes, std::vector<bool>(7, false));
    EXPECT_TRUE(two.is_one(0) && two.is_one(1));
    const Read two_last = read(stack({{-16, 18}, {-8, 19}, {0, 20}, {0, 20.5}, {8, 20}, {8, 20.4}}));
    EXPECT_EQ(two_last.holes, std::vector<bool>(6, false));
}

TEST(NearLines, BesideABodyNoThickerThanTheWallOrThreeInARowBoundAWall) {
    const auto holes = [](std::initializer_list<std::pair<double, double>> rings) {
        return std::ranges::count(read(stack(rings)).holes, true);
    };
    EXPECT_EQ(holes({{-9, 18}, {-8, 19}, {0, 20}, {0, 20.5}}), 1);
    EXPECT_EQ(holes({{-8, 19}, {0, 20}, {0, 20.5}, {8, 20}, {8, 20.5}, {16, 19}}), 2);
    EXPECT_EQ(holes({{-16, 18}, {-8, 19}, {0, 20}, {0, 20.5}, {8, 20}, {8, 20.5}, {16, 20}, {16, 20.5}, {24, 19}, {32, 18}}),
              3);
    EXPECT_EQ(holes({{-16, 18}, {-8, 19}, {0, 20}, {0, 20.5}, {8, 20}, {8, 18}}), 2) << "a cavity beyond";
}

TEST(NearLines, ADeclaredHoleIsOne) {
    std::vector<Contour> contours = drawn_again(0.5);
    contours[1].hole = true;
    const Read wall = read(contours);
    EXPECT_EQ(wall.holes, (std::vector<bool>{false, true, false, false}));
    EXPECT_TRUE(wall.near.empty());
}

TEST(NearLines, PlanesThatPassThroughDecideBeforeThoseBesideIt) {
    std::vector<Contour> contours = drawn_again(0.5);
    contours.push_back(along_axis(20, 20));
    EXPECT_TRUE(read(contours).is_one());
    contours.push_back(along_axis(18, 5));  // a cavity that ends before the planes beside it
    EXPECT_EQ(read(contours).holes, (std::vector<bool>{false, true, false, false, false, true}));
    EXPECT_TRUE(read({ring(0, 20), ring(0, 20.5), along_axis(20, 20)}).is_one()) << "nothing beside it";
}

TEST(NearLines, ThatCrossAreOne) {
    const Read crossing = read({circle(20, 0, 0), circle(20, 2, 0)});
    ASSERT_EQ(crossing.near.size(), 1u);
    EXPECT_TRUE(crossing.is_one());
    EXPECT_FALSE(crossing.near[0].are_nested);
    EXPECT_TRUE(read({circle(20, 0, 0), circle(20, 12, 0)}).near.empty()) << "two parts that overlap";
}

TEST(NearLines, InAHoleAreOneWhereOthersShowTheHole) {
    std::vector<Contour> contours;
    for (const double height : {-8.0, 0.0, 8.0}) {
        contours.push_back(ring(height, 30));
        contours.push_back(ring(height, 20));
    }
    contours.push_back(ring(0, 20.5));
    EXPECT_EQ(read(contours).holes, (std::vector<bool>{false, true, false, true, false, true, true}));
    contours[3].hole = contours.back().hole = true;
    EXPECT_TRUE(read(contours).is_one()) << "declared";
}

TEST(NearLines, DrawnThreeTimesAreOne) {
    std::vector<Contour> contours = drawn_again(0.5);
    contours.push_back(ring(0, 20.9));
    contours.push_back(ring(0, 5));
    EXPECT_EQ(read(contours).holes, (std::vector<bool>{false, false, false, false, false, true}))
        << "in which a hole is one";
}

/// Sections of a ball with a round cavity in its middle, in planes so far apart.
std::vector<Contour> shell(double radius, double cavity, double step) {
    std::vector<Contour> contours;
    for (double z = -step * std::floor(radius / step); z < radius; z += step)
        for (const double r : {radius, cavity})
            if (r > std::abs(z)) contours.push_back(ring(z, std::sqrt(r * r - z * z)));
    return contours;
}

TEST(NearLines, ShellsStayShells) {
    for (const double cavity : {16.0, 18.0, 19.5})
        for (double step = 1.5; step < 20; step *= 1.2) {
            const std::vector<Contour> contours = shell(20, cavity, step);
            const Read walls = read(contours);
            const auto holes = std::ranges::count(walls.holes, true);
            EXPECT_EQ(holes, std::ranges::count_if(contours,
                                                   [&](const Contour& contour) {
                                                       return norm(contour.points.front() - kPlane.origin) <
                                                              (cavity + 20) / 2;
                                                   }))
                << cavity << " in planes " << step << " apart";
        }
}

/// A cup is cut off where its cavity is wide: nothing shows its wall but the planes from its bottom on.
TEST(NearLines, CupsStayCups) {
    for (const double cavity : {16.0, 18.0, 19.0, 19.5})
        for (const double end : {-12.0, -5.0, 0.0})
            for (double step = 0.4; step < 20; step *= 1.2) {
                std::vector<Contour> contours;
                for (double z = end; z > -20; z -= step)
                    for (const double r : {20.0, cavity})
                        if (r > std::abs(z)) contours.push_back(ring(z, std::sqrt(r * r - z * z)));
                const auto walls = std::ranges::count_if(contours, [&](const Contour& contour) {
                    return norm(contour.points.front() - kPlane.origin) < (cavity + 20) / 2;
                });
                EXPECT_EQ(std::ranges::count(read(contours).holes, true), walls)
                    << cavity << " to " << end << " in planes " << step << " apart";
            }
}

TEST(NearLines, WhereAllLinesAreDeclaredAreOneAndNotLeftOut) {
    const Read twice = read(drawn_again(0.5), FillRule::declared);
    EXPECT_EQ(twice.holes.size(), 4u);
    EXPECT_TRUE(twice.is_one());
    EXPECT_EQ(read({ring(0, 10), ring(0, 20)}, FillRule::declared).holes.size(), 1u);
}

}  // namespace
}  // namespace kontur
