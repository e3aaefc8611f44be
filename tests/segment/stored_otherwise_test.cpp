// SPDX-License-Identifier: Apache-2.0
// What a drawing does not say must not matter: where a ring begins, which way it runs, which contour comes first.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "kontur/measure/compare.h"
#include "kontur/phantom/cases.h"
#include "kontur/segment.h"
#include "support/coarse_grid.h"

namespace kontur {
namespace {

struct Way {
    std::string name;
    std::function<void(std::vector<Contour>&)> store;
};

void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

Way rings(const std::string& name, const std::function<void(std::vector<Vec3>&)>& store) {
    return {name, [=](std::vector<Contour>& contours) {
                for (Contour& contour : contours) store(contour.points);
            }};
}

Way begun_later(int points) {
    return rings("begun_later_by_" + std::to_string(points),
                 [=](std::vector<Vec3>& ring) { std::ranges::rotate(ring, ring.begin() + points); });
}

class StoredOtherwise : public testing::TestWithParam<Way> {};

TEST_P(StoredOtherwise, ADrawingIsTheSame) {
    for (const char* name : {"metastasis_parallel7", "kidney_radial6_hand", "liver_oblique10_hand"}) {
        SCOPED_TRACE(name);
        const PhantomCase drawn = phantom_case(name);
        const Grid grid = test::coarse(drawn.grid, 4);
        ContourSet other = drawn.contours;
        GetParam().store(other.contours);
        const Segmentation first = segment(drawn.contours, grid), second = segment(other, grid);
        EXPECT_EQ(first.mask.values, second.mask.values);
        EXPECT_EQ(first.report.bounded, second.report.bounded);
        const std::vector<Vec3>& places = first.samples.points;
        std::vector<double> here(places.size()), there(places.size());
        first.function.values(places, here);
        second.function.values(places, there);
        for (std::size_t i = 0; i < places.size(); ++i) ASSERT_NEAR(here[i], there[i], 2e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, StoredOtherwise,
                         testing::Values(rings("backwards", [](std::vector<Vec3>& ring) { std::ranges::reverse(ring); }),
                                         begun_later(1), begun_later(17),
                                         Way{"last_contour_first",
                                             [](std::vector<Contour>& contours) { std::ranges::reverse(contours); }}),
                         [](const auto& info) { return info.param.name; });

/// More points on the edges of the same polygons.
TEST(SplitEdges, InSixteenPiecesMakeTheSameSurface) {
    for (const char* name : {"metastasis_parallel7", "kidney_radial6_hand", "liver_oblique10_hand"}) {
        SCOPED_TRACE(name);
        const PhantomCase drawn = phantom_case(name);
        const Grid grid = test::coarse(drawn.grid, 4);
        ContourSet split = drawn.contours;
        for (Contour& contour : split.contours) {
            std::vector<Vec3> points;
            for (std::size_t i = 0; i < contour.points.size(); ++i)
                for (int piece = 0; piece < 16; ++piece)
                    points.push_back(contour.points[i] +
                                     piece / 16.0 * (contour.points[(i + 1) % contour.points.size()] - contour.points[i]));
            contour.points = std::move(points);
        }
        const Segmentation first = segment(drawn.contours, grid), second = segment(split, grid);
        EXPECT_GT(compare(first.mask, second.mask).dice, 0.9995) << "a voxel's centre may lie .002 mm beside the surface";
        for (const Vec3& place : first.samples.points)
            ASSERT_NEAR(first.function.value(place), second.function.value(place), 0.1);
    }
}

}  // namespace
}  // namespace kontur
