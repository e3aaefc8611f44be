// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "kontur/io/contours/contour_json.h"
#include "kontur/segment.h"
#include "support/contour_sets.h"
#include "support/solids.h"
#include "support/test_data.h"

namespace kontur {
namespace {

double volume_ml(const ContourSet& set, double margin_mm) {
    return segment(set, grid_around(bounding_box(set), {2, 2, 2}, margin_mm)).report.mask_volume_ml;
}

class RealSetLeakTest : public testing::TestWithParam<const char*> {};

// A sheet that joins the object shows as volume that grows with the image.
TEST_P(RealSetLeakTest, TheImagesExtentDoesNotMatter) {
    const std::filesystem::path file = std::filesystem::path("derived_nonparallel") / GetParam();
    KONTUR_REQUIRE_DATA(file);
    const ContourSet set = read_contour_json(test::data_dir() / file);
    const double near = volume_ml(set, 20);
    EXPECT_NEAR(volume_ml(set, 100), near, 0.01 * near);
}

class SlantedPlanesTest : public testing::TestWithParam<double> {};

// Two planes that cross at a small angle say little of what lies beside them both; a damaged contour tilts the surface
// there.
TEST_P(SlantedPlanesTest, TwoThatCrossGiveAClosedBody) {
    const double angle = GetParam() * std::numbers::pi / 180;
    const Vec3 radii{25, 46, 44};
    const Body body = test::ellipsoid({}, radii);
    const double truth_ml = 4.0 / 3 * std::numbers::pi * radii.x * radii.y * radii.z / 1000;
    const Vec3 normal{0.6, 0.64, 0.48}, sideways{0.8, -0.48, -0.36};
    const std::vector<Plane> planes{make_plane({}, normal),
                                    make_plane({}, std::cos(angle) * normal + std::sin(angle) * sideways)};
    const ContourSet intact = draw_sections(body, planes, 150);
    ContourSet part_missing = intact, crossing_itself = intact;
    std::vector<Vec3>& rest = part_missing.contours[1].points;
    rest.erase(rest.begin(), rest.begin() + 30);
    std::vector<Vec3>& tangled = crossing_itself.contours[1].points;
    std::reverse(tangled.begin() + 37, tangled.begin() + 62);
    for (const ContourSet* set : std::initializer_list<const ContourSet*>{&intact, &part_missing, &crossing_itself}) {
        const double drawn_ml = segment(*set, grid_around(bounding_box(*set), {3, 3, 3}, 150)).report.mask_volume_ml;
        EXPECT_GT(drawn_ml, (set == &intact ? 0.7 : 0.38) * truth_ml);
        EXPECT_LT(drawn_ml, 2 * truth_ml);
    }
}

// Each of two planes counts on the other to end the object. One shows all of it, the other a sliver of it; or a hole of the
// same size is drawn across it.
TEST(Leaks, PlanesThatContradictEachOtherStayBounded) {
    const Plane axial = make_plane({0, 0, -2}, {0, 0, 1}), coronal = make_plane({0, -1, 0}, {0, 1, 0});
    const double ball_ml = 4.0 / 3 * std::numbers::pi * 40 * 40 * 40 / 1000;
    const Contour whole = test::circle(axial, 40, 36), inner = test::circle(axial, 20, 36);
    const Contour sliver{coronal, {{40, -1, 0}, {35, -1, -20}, {20, -1, -35}}};
    Contour hole = test::circle(coronal, 40, 36);
    hole.hole = true;
    for (const std::vector<Contour>& contours : std::vector<std::vector<Contour>>{{whole, sliver}, {whole, hole, inner}}) {
        ContourSet set;
        set.contours = contours;
        const double near_ml = volume_ml(set, 80);
        EXPECT_LT(near_ml, 2 * ball_ml);
        EXPECT_NEAR(volume_ml(set, 160), near_ml, 0.01 * near_ml);
    }
}

struct Stack {
    double radius_mm;
    std::vector<double> heights;
    bool ball;  ///< circles of a ball; else of a cylinder
};

void PrintTo(const Stack& stack, std::ostream* out) {
    *out << (stack.ball ? "ball of " : "cylinder of ") << stack.radius_mm << " mm, " << stack.heights.size() << " planes";
}

class StackTest : public testing::TestWithParam<Stack> {
protected:
    static ContourSet contours() {
        const auto& [radius, heights, ball] = GetParam();
        ContourSet set;
        for (const double z : heights)
            set.contours.push_back(
                test::circle(make_plane({0, 0, z}, {0, 0, 1}), ball ? std::sqrt(radius * radius - z * z) : radius, 60));
        return set;
    }
};

// Behind a gap in which it is negative, f may rise again in cones that widen with the distance.
TEST_P(StackTest, NothingIsInsideBeyondTheEnds) {
    const auto& [radius, heights, ball] = GetParam();
    const ImplicitFunction f = segment(contours(), grid_around(bounding_box(contours()), {1, 1, 1}, 3 * radius)).function;
    const double spacing = heights[1] - heights[0], middle = (heights.front() + heights.back()) / 2, step = radius / 5;
    for (double x = -2 * radius; x <= 2 * radius; x += step)
        for (double y = -2 * radius; y <= 2 * radius; y += step)
            for (double z = heights.back() + std::max(2 * spacing, radius); z < middle + 2 * radius; z += step / 2)
                for (const Vec3& p : {Vec3{x, y, z}, Vec3{x, y, 2 * middle - z}}) {
                    if (distance(p, {0, 0, middle}) > 2 * radius) continue;
                    ASSERT_LT(f.value(p), 0) << x << ", " << y << ", " << p.z;
                }
}

// Voxels thicker than such a gap join what lies on both sides of it.
TEST_P(StackTest, ThickSlicesJoinNothingToTheObject) {
    const auto& [radius, heights, ball] = GetParam();
    const double fine_ml =
        segment(contours(), grid_around(bounding_box(contours()), {0.5, 0.5, 0.5}, 2 * radius)).report.mask_volume_ml;
    for (const double thickness : {0.4 * radius, 0.7 * radius, radius})
        for (const double phase : {0.0, 0.25, 0.5}) {
            Grid grid = grid_around(bounding_box(contours()), {1, 1, thickness}, 3 * radius);
            grid.index_to_mm.translation.z += phase * thickness;
            const double one_slice_ml = std::numbers::pi * radius * radius * thickness / 1000;
            EXPECT_NEAR(segment(contours(), grid).report.mask_volume_ml, fine_ml, one_slice_ml)
                << thickness << " mm thick, " << phase << " of it aside";
        }
}

INSTANTIATE_TEST_SUITE_P(Segment, StackTest,
                         testing::Values(Stack{5, {-1, 1}, true}, Stack{8, {-1.5, 0, 1.5}, true}, Stack{15, {2, 5, 8}, true},
                                         Stack{15, {0, 3, 6}, false}));

INSTANTIATE_TEST_SUITE_P(Segment, SlantedPlanesTest, testing::Values(7, 10, 15, 20, 28, 35, 40, 50, 70, 90));

INSTANTIATE_TEST_SUITE_P(Segment, RealSetLeakTest,
                         testing::Values("lateral_ventricles/ortho3x3.json", "lateral_ventricles/radial6.json",
                                         "lateral_ventricles/tilted_parallel7.json", "hippocampus_label5/oblique10.json",
                                         "kidney_right_5mm/ortho3x3_handdrawn.json", "vertebral_body_L5label/radial6.json"));

}  // namespace
}  // namespace kontur
