// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kontur/segment.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

constexpr double kGap = 3;

struct Stack {
    std::string name;
    ContourSet set;
    double section_mm2;
    int slices;
};

template <class Draw>
Stack stack(std::string name, double section_mm2, int slices, const Draw& draw) {
    Stack made{std::move(name), {}, section_mm2, slices};
    for (int n = 0; n < slices; ++n) draw(make_plane({0, 0, n * kGap}, {0, 0, 1}), made.set.contours);
    return made;
}

/// An outer line of that radius and, where it has a wall, the inner one.
Stack ring(std::string name, double radius, double wall, int slices) {
    const double inner = radius - wall;
    return stack(std::move(name), std::numbers::pi * (radius * radius - inner * inner), slices,
                 [&](const Plane& plane, std::vector<Contour>& contours) {
                     contours.push_back(test::circle(plane, radius, 96));
                     if (inner > 0) contours.push_back(test::circle(plane, inner, 96));
                 });
}

/// A line that crosses itself once, whose signed area is 0.
Stack figure_of_eight(int slices) {
    return stack("figure of eight", 8 / 3.0 * 20 * 10, slices, [](const Plane& plane, std::vector<Contour>& contours) {
        Contour& line = contours.emplace_back(Contour{plane, {}, true, false});
        for (int i = 0; i < 60; ++i) {
            const double t = 2 * std::numbers::pi * (i + 0.5) / 60;
            line.points.push_back(plane.from_uv(20 * std::sin(t), 10 * std::sin(2 * t)));
        }
    });
}

/// Both of its ends are flat, so that it is a gap shorter than the others.
Stack with_flat_ends(Stack made) {
    made.name += " with flat ends";
    for (Contour& contour : made.set.contours)
        if (contour.plane.origin.z == 0 || contour.plane.origin.z > kGap * (made.slices - 1.5))
            contour.end = ContourEnd::flat;
    made.slices -= 1;
    return made;
}

class StackVolume : public testing::TestWithParam<Stack> {};

TEST_P(StackVolume, IsAboutAreaTimesGapHoweverThinOrLow) {
    const Stack& drawn = GetParam();
    const Segmentation made = segment(drawn.set, grid_around(bounding_box(drawn.set), {1, 1, 0.75}, 15));
    const double expected_ml = drawn.section_mm2 * kGap * drawn.slices / 1000;
    EXPECT_GT(made.report.mask_volume_ml, 0.75 * expected_ml);
    EXPECT_LT(made.report.mask_volume_ml, 1.35 * expected_ml);
}

INSTANTIATE_TEST_SUITE_P(Stacks, StackVolume,
                         testing::Values(ring("thin ring", 60, 3, 4), ring("thick ring", 40, 10, 6),
                                         ring("low disc", 40, 40, 6), figure_of_eight(6),
                                         with_flat_ends(ring("thin ring", 60, 3, 8))),
                         [](const auto& info) {
                             std::string name = info.param.name;
                             std::erase(name, ' ');
                             return name;
                         });

TEST(StackSections, AreWholeHoweverLowTheStack) {
    // The ends press on wide sections; bounds inside of the lines hold them.
    const ContourSet set = ring("low disc", 40, 40, 6).set;
    const Segmentation made = segment(set, grid_around(bounding_box(set), {1, 1, 0.75}, 15));
    EXPECT_LT(made.report.section_check.largest_wrong_share(), 0.01);
}

}  // namespace
}  // namespace kontur
