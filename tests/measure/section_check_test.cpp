// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/section_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "kontur/measure/section_faults.h"
#include "kontur/shape/apply_fill_rule.h"
#include "support/contour_sets.h"
#include "support/moved.h"
#include "support/polygons.h"

namespace kontur {
namespace {

using Solid = std::function<double(const Vec3&)>;

PlaceValues values_of(const Solid& solid) {
    return [solid](std::span<const Vec3> places, std::span<double> values) {
        std::transform(places.begin(), places.end(), values.begin(), solid);
    };
}

SectionCheck checked(ContourSet set, const Solid& solid, FillRule rule = FillRule::even_odd) {
    apply_fill_rule(set, rule);
    return check_sections(set, values_of(solid), {}, {.threads = 1});
}

Plane axial_at(double z) { return {{0, 0, z}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}; }

Solid ball(const Vec3& center, double radius) {
    return [=](const Vec3& p) { return radius - distance(p, center); };
}
Solid either(const Solid& a, const Solid& b) {
    return [=](const Vec3& p) { return std::max(a(p), b(p)); };
}
Solid without(const Solid& a, const Solid& b) {
    return [=](const Vec3& p) { return std::min(a(p), -b(p)); };
}
Solid cylinder(double radius, double low, double high) {
    return [=](const Vec3& p) { return std::min({radius - std::hypot(p.x, p.y), p.z - low, high - p.z}); };
}

constexpr double kRadius = 20;

/// Slices of a ball about 0, 4 mm apart.
ContourSet slices() { return test::ball_slices({}, kRadius, 4, 4); }

/// Circles of it in two planes of each main direction.
ContourSet crossing_planes() {
    ContourSet set = test::ball_contours();
    for (Contour& contour : set.contours) {
        for (Vec3& p : contour.points) p -= Vec3{20, -30, 100};
        contour.plane.origin -= Vec3{20, -30, 100};
    }
    return set;
}

/// A contour's section, by its index; fails where it has none.
const PlaneCheck& plane_of(const SectionCheck& check, std::size_t contour) {
    const auto found =
        std::find_if(check.planes.begin(), check.planes.end(), [&](const PlaneCheck& p) { return p.contour == contour; });
    EXPECT_NE(found, check.planes.end());
    return *found;
}

TEST(SectionCheck, SaysNothingOfTheBodyThatWasDrawn) {
    for (const ContourSet& set : {slices(), crossing_planes()}) {
        const SectionCheck check = checked(set, ball({}, kRadius));
        EXPECT_TRUE(sentences(check).empty());
        EXPECT_EQ(check.largest_wrong_share(), 0);
        EXPECT_GE(check.planes.size(), 6u);
    }
}

TEST(SectionCheck, AreaOfAPlaneIsThatOfItsCircle) {
    const ContourSet set = slices();
    const SectionCheck check = checked(set, ball({}, kRadius));
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        const double z = set.contours[c].plane.origin.z, radius = std::sqrt(kRadius * kRadius - z * z);
        EXPECT_NEAR(plane_of(check, c).area_mm2 / (M_PI * radius * radius), 1, 0.01);
    }
}

TEST(SectionCheck, NamesAHoleAndABallOfATenthOfASection) {
    for (const ContourSet& set : {slices(), crossing_planes()}) {
        const double radius = std::sqrt(0.1) * kRadius;
        const SectionCheck hole = checked(set, without(ball({}, kRadius), ball({6, 4, 2}, radius)));
        EXPECT_EQ(sentences(hole).size(), 1u);
        EXPECT_NEAR(hole.largest_wrong_share(), 0.1, 0.03);
        const SectionCheck bump = checked(set, either(ball({}, kRadius), ball({0, 22, -7}, 5)));
        EXPECT_GE(bump.wrong_planes(), 1u);
    }
}

TEST(SectionCheck, RegionsTellPlaceAreaAndKind) {
    const double at = slices().contours[4].plane.origin.z;
    const SectionCheck island = checked(slices(), either(ball({}, kRadius), ball({23.5, 0, at}, 2)));
    const PlaneCheck& plane = plane_of(island, 4);
    ASSERT_EQ(plane.regions.size(), 1u);
    EXPECT_TRUE(plane.regions[0].is_island);
    EXPECT_FALSE(plane.regions[0].is_missing);
    EXPECT_LT(distance(plane.regions[0].position, {25.5, 0, at}), 1.2);  // its side away from the circle
    EXPECT_NEAR(plane.regions[0].area_mm2, M_PI * 4, 1.5);
    EXPECT_NEAR(plane.island_share, 4 / (kRadius * kRadius - at * at), 0.004);

    const SectionCheck hole = checked(slices(), without(ball({}, kRadius), ball({0, 0, at}, 5)));
    const WrongRegion& missing = plane_of(hole, 4).regions.at(0);
    EXPECT_TRUE(missing.is_missing);
    EXPECT_FALSE(missing.is_lost);
    EXPECT_LT(distance(missing.position, {0, 0, at}), 1);
    EXPECT_NEAR(missing.area_mm2, M_PI * 25, 3);
}

TEST(SectionCheck, NamesAnIslandFarFromTheLines) {
    const double at = slices().contours[4].plane.origin.z;
    const SectionCheck check = checked(slices(), either(ball({}, kRadius), ball({0, -24, at}, 3)));
    EXPECT_TRUE(plane_of(check, 4).is_wrong);
    ASSERT_EQ(sentences(check).size(), 1u);
    EXPECT_NE(sentences(check)[0].find("an island that was not drawn"), std::string::npos) << sentences(check)[0];
}

TEST(SectionCheck, NamesAnOutlineOfWhichNothingIsLeft) {
    ContourSet set = slices();
    set.contours.push_back(test::circle(set.contours[4].plane, 2, 26, 0));
    const SectionCheck check = checked(set, ball({}, kRadius));
    EXPECT_TRUE(plane_of(check, 4).regions.at(0).is_lost);
    EXPECT_LT(plane_of(check, 4).wrong_share, 0.02);
    EXPECT_EQ(check.wrong_planes(), 1u);
}

TEST(SectionCheck, AnUnsteadyHandIsNoFault) {
    const SectionCheck check = checked(slices(), ball({0.15, 0, 0}, kRadius));  // 0.0045 of the diameter are 0.18 mm
    EXPECT_EQ(check.wrong_planes(), 0u);
}

TEST(SectionCheck, WherePlanesContradictEachOtherNoResultIsWrong) {
    ContourSet set = crossing_planes();
    // One contour was drawn 6 mm aside of where the others have the ball.
    for (Vec3& p : set.contours[4].points) p.x += 6;
    const SectionCheck check = checked(set, ball({}, kRadius));
    const PlaneCheck& moved = plane_of(check, 4);
    ASSERT_FALSE(moved.regions.empty());
    EXPECT_TRUE(
        std::all_of(moved.regions.begin(), moved.regions.end(), [](const WrongRegion& r) { return r.is_explained; }));
    EXPECT_FALSE(moved.is_wrong);
    // In a stack nothing can contradict: there the same is a fault.
    ContourSet stack = slices();
    for (Vec3& p : stack.contours[4].points) p.x += 6;
    EXPECT_TRUE(plane_of(checked(stack, ball({}, kRadius)), 4).is_wrong);
}

TEST(SectionCheck, AnEmptyPlaneIsEmptyEverywhere) {
    ContourSet set = slices();
    set.empty_planes.push_back(make_plane({24, 0, 0}, {1, 0, 0}));
    EXPECT_TRUE(sentences(checked(set, ball({}, kRadius))).empty());
    const SectionCheck check = checked(set, either(ball({}, kRadius), ball({22, 0, 2}, 6)));
    ASSERT_FALSE(check.planes.back().contour);
    EXPECT_TRUE(check.planes.back().is_wrong);
    EXPECT_NEAR(check.planes.back().regions.at(0).area_mm2, M_PI * (36 - 4), 12);
}

TEST(SectionCheck, PlacesBesideAnOpenLineDoNotCount) {
    ContourSet set = slices();
    Contour line{set.contours[4].plane, {}, false};
    for (int i = -10; i <= 10; ++i) line.points.push_back(line.plane.from_uv(26, 0.6 * i));
    const Solid more = either(ball({}, kRadius), ball({26, 0, line.plane.origin.z}, 2.5));
    EXPECT_TRUE(plane_of(checked(set, more), 4).is_wrong);
    set.contours.push_back(line);
    EXPECT_FALSE(plane_of(checked(set, more), 4).is_wrong);
}

TEST(SectionCheck, AClickThatContradictsAPlaneExplains) {
    ContourSet set = slices();
    const double at = set.contours[4].plane.origin.z;
    const Solid more = either(ball({}, kRadius), ball({26, 0, at}, 3));
    set.interior.push_back({26, 0, at});
    EXPECT_FALSE(plane_of(checked(set, more), 4).is_wrong);
    set.interior = {{-26, 0, at}};
    EXPECT_TRUE(plane_of(checked(set, more), 4).is_wrong);
}

TEST(SectionCheck, FillRuleSaysWhetherInnerContoursAreHoles) {
    ContourSet set = slices();
    for (std::size_t c = 2; c < 7; ++c) set.contours.push_back(test::circle(set.contours[c].plane, 8, 60));
    const Solid hollow =
        without(ball({}, kRadius), cylinder(8, set.contours[2].plane.origin.z - 2, set.contours[6].plane.origin.z + 2));
    EXPECT_EQ(checked(set, hollow).wrong_planes(), 0u);
    EXPECT_EQ(checked(set, ball({}, kRadius)).wrong_planes(), 5u);
    EXPECT_EQ(checked(set, ball({}, kRadius), FillRule::declared).wrong_planes(), 0u);
    EXPECT_EQ(checked(set, hollow, FillRule::declared).wrong_planes(), 5u);
}

TEST(SectionCheck, OverlappingOutlinesAreTheirUnion) {
    ContourSet set;
    for (int n = 0; n < 6; ++n)
        for (const double x : {-6.0, 6.0}) set.contours.push_back(test::circle(axial_at(3.0 * n), 10, x, 0));
    const auto disc = [](double x) {
        return [x](const Vec3& p) { return std::min({10 - std::hypot(p.x - x, p.y), p.z + 1.5, 16.5 - p.z}); };
    };
    EXPECT_EQ(checked(set, either(disc(-6), disc(6))).wrong_planes(), 0u);
    const Solid apart = [=](const Vec3& p) { return std::min(disc(-6)(p), -disc(6)(p)); };
    EXPECT_EQ(checked(set, either(apart, [=](const Vec3& p) { return std::min(disc(6)(p), -disc(-6)(p)); })).wrong_planes(),
              6u);
}

/// Six equal circles 3 mm apart.
ContourSet drum(ContourEnd end = ContourEnd::automatic) {
    ContourSet set;
    for (int n = 0; n < 6; ++n) set.contours.push_back(test::circle(axial_at(3.0 * n), 40, 100));
    set.contours.front().end = set.contours.back().end = end;
    return set;
}

TEST(SectionCheck, NamesWhatGoesOnFarBeyondALastPlane) {
    EXPECT_TRUE(sentences(checked(drum(), cylinder(40, -3, 18))).empty());
    const SectionCheck check = checked(drum(), cylinder(40, -9, 18));
    ASSERT_EQ(sentences(check).size(), 1u);
    const auto wrong =
        std::find_if(check.beyond.begin(), check.beyond.end(), [](const BeyondCheck& b) { return b.is_wrong; });
    EXPECT_EQ(wrong->contour, 0u);
    EXPECT_NEAR(wrong->length_mm, 9, 0.3);
    EXPECT_EQ(wrong->gap_mm, 3);
}

TEST(SectionCheck, AFlatEndIsHeldToItsPlane) {
    EXPECT_TRUE(sentences(checked(drum(ContourEnd::flat), cylinder(40, -0.5, 15.5))).empty());
    EXPECT_EQ(sentences(checked(drum(ContourEnd::flat), cylinder(40, -3, 15.5))).size(), 1u);
}

TEST(SectionCheck, NamesWhatIsMissingBetweenTwoPlanes) {
    ContourSet set;
    for (int n = 0; n < 6; ++n) set.contours.push_back(test::circle(axial_at(33.0 * n), 5, 60));
    const SectionCheck tube = checked(set, cylinder(5, -10, 175));
    EXPECT_TRUE(sentences(tube).empty());
    const Solid pearls = [](const Vec3& p) { return 5 - std::hypot(p.x, p.y, p.z - 33 * std::round(p.z / 33)); };
    const SectionCheck check = checked(set, pearls);
    ASSERT_EQ(sentences(check).size(), 1u);
    EXPECT_EQ(std::count_if(check.between.begin(), check.between.end(), [](const BetweenCheck& b) { return b.is_wrong; }),
              10);
    EXPECT_EQ(check.between.front().missing_share, 1);
    EXPECT_NEAR(check.between.front().gap_mm, 33, 1e-9);
    // A third plane that shows nothing there, or an exterior point, says that it is no fault.
    for (int n = 0; n < 5; ++n) set.exterior.push_back({0, 0, 33.0 * n + 16.5});
    EXPECT_TRUE(sentences(checked(set, pearls)).empty());
}

TEST(SectionCheck, NamesWhatRunsAwayFromTheDrawing) {
    const SectionCheck check = checked(slices(), [](const Vec3& p) { return 15 - std::hypot(p.x, p.y); });
    EXPECT_TRUE(check.is_outside_wrong);
    EXPECT_GT(check.outside_share, 0.2);
}

TEST(SectionCheck, FaultsAreOnePlaceForEachPlaneAndPair) {
    EXPECT_TRUE(faults(checked(slices(), ball({}, kRadius))).empty());
    const double at = slices().contours[4].plane.origin.z;
    const std::vector<SectionFault> island = faults(checked(slices(), either(ball({}, kRadius), ball({24, 0, at}, 2))));
    ASSERT_EQ(island.size(), 1u);
    EXPECT_EQ(name(island[0].kind), "island");
    EXPECT_EQ(island[0].contours, std::vector<std::size_t>{4});
    EXPECT_LT(distance(island[0].position, {26, 0, at}), 1.2);
    ContourSet rings;
    for (int n = 0; n < 6; ++n) rings.contours.push_back(test::circle(axial_at(33.0 * n), 5, 60));
    const std::vector<SectionFault> pearls =
        faults(checked(rings, [](const Vec3& p) { return 5 - std::hypot(p.x, p.y, p.z - 33 * std::round(p.z / 33)); }));
    ASSERT_EQ(pearls.size(), 5u);
    for (const SectionFault& fault : pearls) {
        EXPECT_EQ(name(fault.kind), "between");
        EXPECT_EQ(fault.share, 1);
        EXPECT_NEAR(fault.length_mm, 33, 1e-9);
        EXPECT_EQ(fault.contours.size(), 2u);
    }
    const std::vector<SectionFault> far = faults(checked(drum(), cylinder(40, -9, 18)));
    ASSERT_EQ(far.size(), 1u);
    EXPECT_EQ(name(far[0].kind), "beyond");
    EXPECT_NEAR(far[0].length_mm, 9, 0.3);
    const std::vector<SectionFault> away =
        faults(checked(slices(), [](const Vec3& p) { return 15 - std::hypot(p.x, p.y); }));
    ASSERT_FALSE(away.empty());
    EXPECT_EQ(name(away.back().kind), "outside");
}

TEST(SectionCheck, NamesWhatIsMissingAlongABend) {
    constexpr double kTube = 5, kTurn = 60;
    const auto middle = [](double angle) { return Vec3{kTurn * std::cos(angle), kTurn * std::sin(angle), 0}; };
    ContourSet set;
    for (int n = 0; n <= 6; ++n) {
        const double angle = n * M_PI / 6;
        set.contours.push_back(test::circle(make_plane(middle(angle), {-std::sin(angle), std::cos(angle), 0}), kTube, 40));
    }
    const Solid arch = [](const Vec3& p) {
        return std::min(kTube - std::hypot(std::hypot(p.x, p.y) - kTurn, p.z), p.y + 3);
    };
    EXPECT_TRUE(sentences(checked(set, arch)).empty());
    const Solid pearls = [&](const Vec3& p) {
        double nearest = 1e9;
        for (int n = 0; n <= 6; ++n) nearest = std::min(nearest, distance(p, middle(n * M_PI / 6)));
        return kTube - nearest;
    };
    const SectionCheck check = checked(set, pearls);
    ASSERT_EQ(std::ranges::count_if(check.between, [](const BetweenCheck& b) { return b.is_wrong; }), 6);
    EXPECT_EQ(check.between.front().missing_share, 1);
    EXPECT_NEAR(check.between.front().gap_mm, 2 * kTurn * std::sin(M_PI / 12), 1e-6);
    EXPECT_NEAR(std::hypot(check.between.front().position.x, check.between.front().position.y), kTurn, kTube);
}

TEST(SectionCheck, TwoBodiesBesideEachOtherAreNotOneTube) {
    ContourSet set = test::ball_slices({}, kRadius, 4, 4);
    for (const Contour& contour : test::ball_slices({70, 0, 0}, kRadius, 4, 4).contours) set.contours.push_back(contour);
    EXPECT_TRUE(sentences(checked(set, either(ball({}, kRadius), ball({70, 0, 0}, kRadius)))).empty());
}

/// Rings across a helix: their planes cut its other turns, which nobody draws there.
TEST(SectionCheck, RingsAcrossAVesselSayNothingOfItsOtherTurns) {
    constexpr double kTube = 4, kTurn = 30, kPitch = 24;
    const auto middle = [](double angle) {
        return Vec3{kTurn * std::cos(angle), kTurn * std::sin(angle), kPitch * angle / (2 * M_PI)};
    };
    ContourSet set;
    for (int n = 0; n <= 36; ++n) {
        const double angle = n * M_PI / 6;
        const Vec3 along{-kTurn * std::sin(angle), kTurn * std::cos(angle), kPitch / (2 * M_PI)};
        set.contours.push_back(test::circle(make_plane(middle(angle), normalized(along)), kTube, 40));
    }
    const Solid helix = [&](const Vec3& p) {
        double nearest = 1e9;
        for (double angle = 0; angle <= 6 * M_PI; angle += 0.02) nearest = std::min(nearest, distance(p, middle(angle)));
        return kTube - nearest;
    };
    const SectionCheck check = checked(set, helix);
    EXPECT_TRUE(sentences(check).empty()) << sentences(check).front();
}

/// A comb: the middle slice shows its back alone, and the result has a tooth there.
TEST(SectionCheck, PlanesThatCrossAStackDoNotLetItsSlicesSilenceEachOther) {
    ContourSet set;
    for (const double z : {-4.0, -2.0, 0.0, 2.0, 4.0}) {
        set.contours.push_back(test::circle(axial_at(z), 3, 40));
        if (z == 0) continue;
        set.contours.push_back(test::circle(axial_at(z), 6, 60));
        for (Vec3& p : set.contours.back().points) p.x += 20;
    }
    const Solid joined = [](const Vec3& p) {
        return std::min(5 - std::abs(p.z), std::max(3 - std::hypot(p.x, p.y), 6 - std::hypot(p.x - 20, p.y)));
    };
    EXPECT_EQ(checked(set, joined).wrong_planes(), 1u);
    ContourSet with_empty = set;
    with_empty.empty_planes.push_back(make_plane({0, -30, 0}, {0.2, 1, 0.4}));
    EXPECT_EQ(checked(with_empty, joined).wrong_planes(), 1u);
    // A plane across the back.
    set.contours.push_back({make_plane({0, 0, 0}, {1, 0, 0}), {{0, -3, -5}, {0, 3, -5}, {0, 3, 5}, {0, -3, 5}}});
    EXPECT_EQ(checked(set, joined).wrong_planes(), 1u);
}

TEST(SectionCheck, IsTheSameForAnyNumberOfThreads) {
    ContourSet set = crossing_planes();
    apply_fill_rule(set, FillRule::even_odd);
    const PlaceValues values = values_of(either(ball({}, kRadius), ball({19, 3, 2}, 8)));
    const SectionCheck one = check_sections(set, values, {}, {.threads = 1});
    EXPECT_GT(one.wrong_planes(), 0u);
    for (const int threads : {2, 3, 7}) EXPECT_EQ(check_sections(set, values, {}, {.threads = threads}), one);
}

TEST(SectionCheck, AsksAgainWhereAValueLooksWrong) {
    ContourSet set = slices();
    apply_fill_rule(set, FillRule::even_odd);
    const Solid hole = without(ball({}, kRadius), ball({0, 0, set.contours[4].plane.origin.z}, 5));
    EXPECT_EQ(check_sections(set, values_of(hole), values_of(ball({}, kRadius))).wrong_planes(), 0u);
}

TEST(SectionCheck, OfNothingSaysNothing) {
    EXPECT_TRUE(check_sections({}, values_of(ball({}, 1))).planes.empty());
    ContourSet open;
    open.contours.push_back({axial_at(0), {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}}, false});
    EXPECT_TRUE(sentences(check_sections(open, values_of(ball({}, 1)))).empty());
}

}  // namespace
}  // namespace kontur
