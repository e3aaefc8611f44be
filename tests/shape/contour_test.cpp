// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/contour.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "kontur/base/error.h"
#include "kontur/shape/grid.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

using test::three_circles;

/// The message of the refusal; empty when the set passes.
std::string refusal(const ContourSet& set, const ContourCheckOptions& options = {}) {
    try {
        check_contours(set, options);
        return {};
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        return error.what();
    }
}

TEST(ContourSet, CountsAndBoundsAllPoints) {
    const ContourSet set = three_circles();
    EXPECT_EQ(point_count(set), 60u);
    Box3 box;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) box.extend(p);
    EXPECT_EQ(bounding_box(set).min, box.min);
    EXPECT_EQ(bounding_box(set).max, box.max);
    EXPECT_TRUE(bounding_box(ContourSet{}).is_empty());
    EXPECT_EQ(point_count(ContourSet{}), 0u);
}

TEST(CheckContours, AcceptsCirclesInObliquePlanes) { EXPECT_EQ(refusal(three_circles()), ""); }

TEST(CheckContours, RefusesAnEmptySet) { EXPECT_EQ(refusal({}), "there is no contour; at least 1 is needed"); }

TEST(CheckContours, NamesTheContourWithTooFewPoints) {
    for (const auto& [count, text] : {std::pair{0, "0 points"}, {1, "1 point"}, {2, "2 points"}}) {
        ContourSet set = three_circles();
        set.contours[1].points.resize(count);
        EXPECT_EQ(refusal(set), std::string("contour 2 has ") + text + "; at least 3 are needed");
    }
}

TEST(CheckContours, AnOpenStretchNeedsTwoPointsAndNoArea) {
    ContourSet set = three_circles();
    set.contours[1].closed = false;
    set.contours[1].points.resize(2);
    EXPECT_EQ(refusal(set), "");
    set.contours[1].points.resize(1);
    EXPECT_EQ(refusal(set), "contour 2 has 1 point; at least 2 are needed");
}

TEST(CheckContours, RefusesMeaningsThatContradictEachOther) {
    const auto refused = [](const auto& change) {
        ContourSet set = three_circles();
        change(set.contours[0]);
        return refusal(set);
    };
    EXPECT_EQ(refused([](Contour& c) { c.closed = false, c.hole = true; }),
              "contour 1 is open and a hole; only closed contours can be holes");
    EXPECT_EQ(refused([](Contour& c) { c.closed = false, c.end = ContourEnd::flat; }),
              "contour 1 is open and ends the object; only closed contours can");
    EXPECT_EQ(refused([](Contour& c) { c.hole = true, c.end = ContourEnd::round; }),
              "contour 1 is a hole and ends the object; only an outer contour can");
    EXPECT_EQ(refused([](Contour& c) { c.inside = Hand::left; }),
              "contour 1 is closed and says on which hand the object lies; only open contours need that");
    EXPECT_EQ(refused([](Contour& c) { c.closed = false, c.inside = Hand::left; }), "");
    EXPECT_EQ(refused([](Contour& c) { c.end = ContourEnd::flat; }), "");
    EXPECT_EQ(refused([](Contour& c) { c.weight = 0; }), "contour 1 has the weight 0; it must be from 0.001 to 1000");
    EXPECT_NE(refused([](Contour& c) { c.weight = std::numeric_limits<double>::quiet_NaN(); }), "");
    EXPECT_EQ(refused([](Contour& c) { c.weight = 1000; }), "");
}

TEST(CheckContours, SurfacePointsAreFiniteAndTheirDirectionsUnit) {
    ContourSet set = three_circles();
    set.surface = {{{0, 0, 90}, {}}, {{1, 2, 3}, Vec3{0, 0.6, 0.8}}};
    EXPECT_EQ(refusal(set), "");
    EXPECT_TRUE(bounding_box(set).contains({0, 0, 90}));
    set.surface[1].outward = Vec3{0, 3, 4};
    EXPECT_EQ(refusal(set), "the outward direction of surface point 2 has length 5, not 1");
    set.surface[0].position.y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(refusal(set), "point 1 of the surface points has a NaN or infinite coordinate");
}

TEST(CheckContours, RefusesSurfacePointsOfAnotherPlace) {
    ContourSet set = three_circles();
    const double size = bounding_box(set).diagonal();
    const Vec3 center = bounding_box(set).center();
    set.surface = {{center + Vec3{99 * size, 0, 0}}};
    EXPECT_EQ(refusal(set), "");
    set.surface.push_back({center + Vec3{0, 1000 * size, 0}});
    EXPECT_NE(refusal(set).find("surface point 2 lies "), std::string::npos);
    EXPECT_NE(refusal(set).find(" mm from the contours, 1e+03 times their size; the limit is 100 times"), std::string::npos);
}

TEST(CheckContours, RefusesHolesInNothing) {
    ContourSet set = three_circles();
    for (Contour& contour : set.contours) contour.hole = true;
    EXPECT_EQ(refusal(set), "all contours are holes (3); at least 1 must be none");
    set.contours[1].hole = false;
    EXPECT_EQ(refusal(set), "");
}

TEST(CheckContours, NamesThePointThatIsNotFinite) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (int axis = 0; axis < 3; ++axis) {
            ContourSet set = three_circles();
            set.contours[2].points[6][axis] = bad;
            EXPECT_EQ(refusal(set), "point 7 of contour 3 has a NaN or infinite coordinate");
        }
    ContourSet set = three_circles();
    set.exterior = {{0, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}};
    EXPECT_EQ(refusal(set), "point 2 of the exterior points has a NaN or infinite coordinate");
}

TEST(CheckContours, NamesThePointFarthestOffItsPlane) {
    ContourSet set = three_circles();
    const Vec3 normal = set.contours[2].plane.normal;
    set.contours[2].points[3] += 1.5 * normal;
    set.contours[2].points[6] -= 2.4 * normal;
    EXPECT_EQ(refusal(set), "point 7 of contour 3 lies 2.4 mm off its plane; the limit is 0.01 mm");
    EXPECT_EQ(refusal(set, {.plane_tolerance_mm = 2.5}), "");
}

TEST(CheckContours, AcceptsCoordinatesRoundedToAThousandth) {
    ContourSet set = three_circles();
    for (Contour& contour : set.contours)
        for (Vec3& p : contour.points)
            for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * 1000) / 1000;
    EXPECT_EQ(refusal(set), "");
}

TEST(CheckContours, RefusesPointsOnOneLine) {
    const Plane plane = make_plane({5, 5, 5}, {1, 1, 1});
    ContourSet set;
    set.contours.push_back({plane, {}, true, false});
    for (const double s : {0.0, 10.0, 3.0, 40.0, 7.0}) set.contours[0].points.push_back(plane.from_uv(s, 2 * s));
    EXPECT_TRUE(refusal(set).starts_with("contour 1 has no area: its 5 points lie within")) << refusal(set);
    for (Vec3& p : set.contours[0].points)
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * 1000) / 1000;
    EXPECT_TRUE(refusal(set).starts_with("contour 1 has no area")) << "rounding does not make a line a contour";
    set.contours[0].points.assign(4, plane.origin);
    EXPECT_TRUE(refusal(set).starts_with("contour 1 has no area: its 4 points lie within 0 mm")) << refusal(set);
}

TEST(CheckContours, AcceptsAFigureOfEightWhoseSignedAreaIsZero) {
    const Plane plane = make_plane({}, {0, 0, 1});
    ContourSet set;
    set.contours.push_back({plane, {{0, 0, 0}, {10, 10, 0}, {10, 0, 0}, {0, 10, 0}}, true, false});
    EXPECT_EQ(refusal(set), "");
}

TEST(CheckContours, RefusesAPlaneWithoutDirection) {
    for (const Vec3& normal : {Vec3{}, Vec3{0, 0, 2}, Vec3{0, 0, std::numeric_limits<double>::quiet_NaN()}}) {
        ContourSet set = three_circles();
        set.contours[0].plane.normal = normal;
        EXPECT_NE(refusal(set).find("the plane of contour 1"), std::string::npos) << refusal(set);
    }
}

TEST(DropDuplicatePoints, RemovesNeighboursAndTheClosingPointAndCountsThem) {
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0};
    ContourSet set;
    set.contours.push_back({Plane{}, {a, a, b, b, b, c, a, a}, true, false});
    set.contours.push_back({Plane{}, {a, b, a, c}, true, false});
    set.contours.push_back({Plane{}, {a, b, c, a}, false, false});
    EXPECT_EQ(drop_duplicate_points(set), 5u);
    EXPECT_EQ(set.contours[0].points, (std::vector<Vec3>{a, b, c}));
    EXPECT_EQ(set.contours[1].points, (std::vector<Vec3>{a, b, a, c})) << "a contour may touch itself";
    EXPECT_EQ(set.contours[2].points, (std::vector<Vec3>{a, b, c, a})) << "an open contour may end where it began";
    EXPECT_EQ(drop_duplicate_points(set), 0u);
}

TEST(DropDuplicatePoints, LeavesOneOfManyEqualPoints) {
    ContourSet set;
    set.contours.push_back({Plane{}, std::vector<Vec3>(7, Vec3{1, 2, 3}), true, false});
    EXPECT_EQ(drop_duplicate_points(set), 6u);
    EXPECT_EQ(refusal(set), "contour 1 has 1 point; at least 3 are needed");
}

/// 10 x 20 x 5 voxels, sheared, so that its bounding box holds far more than its voxels.
Grid sheared_grid() {
    Grid grid{{10, 20, 5}, {}};
    grid.index_to_mm.set_column(0, {0.5, 0, 0});
    grid.index_to_mm.set_column(1, {1, 0.5, 0});
    grid.index_to_mm.set_column(2, {0, 1, 2});
    grid.index_to_mm.translation = {100, -50, 7};
    return grid;
}

ContourSet points_at_indices(const Grid& grid, const std::vector<Vec3>& indices) {
    ContourSet set;
    set.contours.push_back({Plane{}, {}, true, false});
    for (const Vec3& index : indices) set.contours[0].points.push_back(grid.index_to_mm.apply(index));
    return set;
}

TEST(ContourProblems, ListsOnePerContourInOrder) {
    EXPECT_TRUE(contour_problems(three_circles()).empty());
    ContourSet set = three_circles();
    set.contours[0].points.resize(2);
    set.contours[2].points[4] += 0.5 * set.contours[2].plane.normal;
    set.contours[2].points[5] += 0.5 * set.contours[2].plane.normal;
    const std::vector<std::string> problems = contour_problems(set);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0], "contour 1 has 2 points; at least 3 are needed");
    EXPECT_NE(problems[1].find("of contour 3 lies 0.5 mm off its plane"), std::string::npos) << problems[1];
}

TEST(CheckContoursInside, AcceptsPointsUpToTheOuterFaces) {
    const ContourSet set = points_at_indices(sheared_grid(), {{-0.5, -0.5, -0.5}, {9.5, 19.5, 4.5}, {3, 4, 2}});
    EXPECT_EQ(points_outside(set, sheared_grid()), 0u);
    EXPECT_EQ(check_contours_inside(set, sheared_grid()), std::nullopt);
}

TEST(CheckContoursInside, WarnsWithTheNumberOutside) {
    const ContourSet set = points_at_indices(sheared_grid(), {{-0.6, 0, 0}, {0, 19.6, 0}, {3, 4, 2}, {0, 0, 4.6}});
    EXPECT_EQ(points_outside(set, sheared_grid()), 3u);
    EXPECT_EQ(check_contours_inside(set, sheared_grid()), "3 of 4 contour points lie outside of the image");
}

TEST(CheckContoursInside, WarnsOfAnImageBetweenTheDrawnPlanes) {
    const ContourSet set = points_at_indices(sheared_grid(), {{3, 4, -30}, {5, 9, 60}, {4, 6, 60}});
    EXPECT_EQ(check_contours_inside(set, sheared_grid()), "3 of 3 contour points lie outside of the image");
}

TEST(CheckContoursInside, RefusesContoursOfAnotherPlace) {
    const ContourSet set = points_at_indices(sheared_grid(), {{-60, 0, 0}, {-2, 190.6, 0}, {-9, 0, 46}});
    EXPECT_THROW(check_contours_inside(set, sheared_grid()), Error);
}

}  // namespace
}  // namespace kontur
