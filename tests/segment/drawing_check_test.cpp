// SPDX-License-Identifier: Apache-2.0
// A result against its drawing, asked of voxels and of f.
#include "kontur/drawing_check.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/pipeline.h"
#include "kontur/segment.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

/// A ball by slices, and a strip of 12 by 1.6 mm that a last slice has beside it.
ContourSet ball_and_strip() {
    ContourSet set = test::ball_slices({}, 20, 4, 4);
    for (const std::size_t c : {3u, 4u, 5u}) {
        Contour strip{set.contours[c].plane, {}};
        for (const auto& [u, v] : {std::pair{28.0, -6.0}, {29.6, -6.0}, {29.6, 6.0}, {28.0, 6.0}})
            strip.points.push_back(strip.plane.from_uv(u, v));
        set.contours.push_back(strip);
    }
    return set;
}

Segmentation segmented(const ContourSet& set, double spacing_mm) {
    return segment(set, grid_around(bounding_box(set), {spacing_mm, spacing_mm, spacing_mm}, 8));
}

/// A tube by rings, and a ball farther up, aside of it.
ContourSet tube_and_ball() {
    ContourSet set = test::ball_slices({60, 0, 80}, 20, 4, 4);
    for (int n = 0; n < 8; ++n)
        set.contours.push_back(test::circle({{0, 0, 6.0 * n}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 1.5, 24));
    return set;
}

SectionCheck by_function(const ContourSet& set, const Segmentation& result) {
    return check_sections(read_drawing(set, FillRule::even_odd), result.function);
}

std::size_t wrong_count(const std::vector<BetweenCheck>& between) {
    return static_cast<std::size_t>(std::ranges::count_if(between, [](const BetweenCheck& b) { return b.is_wrong; }));
}

TEST(DrawingCheck, VoxelsWiderThanATubeDoNotHideIt) {
    const Segmentation result = segmented(tube_and_ball(), 5);
    const SectionCheck &voxels = result.report.section_check, function = by_function(tube_and_ball(), result);
    EXPECT_EQ(voxels.wrong_planes(), function.wrong_planes());
    EXPECT_EQ(wrong_count(voxels.between), wrong_count(function.between));
    EXPECT_EQ(function.wrong_planes(), 0u);
}

TEST(DrawingCheck, VoxelsAndFunctionTellTheSame) {
    ContourSet set = ball_and_strip();
    for (Vec3& p : set.contours[2].points) p.x += 9;
    const Segmentation result = segmented(set, 1);
    const SectionCheck &voxels = result.report.section_check, function = by_function(set, result);
    ASSERT_EQ(voxels.planes.size(), function.planes.size());
    for (std::size_t p = 0; p < voxels.planes.size(); ++p)
        EXPECT_NEAR(voxels.planes[p].wrong_share, function.planes[p].wrong_share, 0.01) << p;
}

}  // namespace
}  // namespace kontur
