// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "kontur/io/contour_json.h"
#include "kontur/segment.h"
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
        EXPECT_GT(drawn_ml, 0.5 * truth_ml);
        EXPECT_LT(drawn_ml, 2 * truth_ml);
    }
}

INSTANTIATE_TEST_SUITE_P(Segment, SlantedPlanesTest, testing::Values(7, 10, 15, 20, 28, 35, 40, 50, 70, 90));

INSTANTIATE_TEST_SUITE_P(Segment, RealSetLeakTest,
                         testing::Values("lateral_ventricles/ortho3x3.json", "lateral_ventricles/radial6.json",
                                         "lateral_ventricles/tilted_parallel7.json", "hippocampus_label5/oblique10.json",
                                         "kidney_right_5mm/ortho3x3_handdrawn.json", "vertebral_body_L5label/radial6.json"));

}  // namespace
}  // namespace kontur
