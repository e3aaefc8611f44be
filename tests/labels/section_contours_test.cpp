// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/section_contours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "kontur/extract/rasterize.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

using test::index_grid;
using test::label_map;

/// The only slice of a mask on a grid with one.
PaintedSlice section_where(const Grid& grid, const std::function<bool(const Index3&)>& painted) {
    PaintedSlice slice;
    const Image map = label_map(grid, painted);
    slice.section = test::bytes_of_labels(map);
    return slice;
}

TEST(SectionContours, EncloseExactlyThePaintedCentres) {
    const Grid grid = index_grid({30, 26, 1}, {0.7, 1.3, 4});
    for (const double smoothing : {0.0, 0.5, 0.7, 1.5})
        for (const std::uint32_t seed : {1U, 2U, 3U}) {
            std::uint32_t state = seed;
            const PaintedSlice slice = section_where(grid, [&](const Index3&) {
                state = state * 1664525U + 1013904223U;
                return state >> 29 < 4;
            });
            const ContourSet set{"", section_contours(grid, slice, {smoothing}), {}, {}};
            EXPECT_EQ(rasterize(set, grid).values, slice.section) << smoothing << ", seed " << seed;
        }
}

TEST(SectionContours, ACircleIsCloserThanItsVoxels) {
    const Grid grid = index_grid({64, 64, 1});
    const Vec3 center{31.3, 31.8, 0};
    constexpr double kRadius = 20.2;
    const PaintedSlice slice = section_where(
        grid, [&](const Index3& at) { return std::hypot(double(at.i) - center.x, double(at.j) - center.y) < kRadius; });
    const auto mean_square_error = [&](double smoothing) {
        double sum = 0;
        std::size_t count = 0;
        for (const Contour& contour : section_contours(grid, slice, {smoothing}))
            for (const Vec3& p : contour.points) sum += std::pow(distance(p, center) - kRadius, 2), ++count;
        return sum / static_cast<double>(count);
    };
    EXPECT_LT(mean_square_error(SectionContourOptions{}.smoothing_voxels), 0.65 * mean_square_error(0));
}

TEST(SectionContours, HolesAreMarkedAndPointsLieInTheSlicesPlane) {
    Grid grid = index_grid({1, 40, 40}, {3, 1, 1});
    grid.index_to_mm.translation = {5, -7, 11};
    PaintedSlice slice = section_where(grid, [](const Index3& at) {
        const double r = std::hypot(double(at.j) - 20, double(at.k) - 20);
        return r < 15 && r > 6;
    });
    slice.axis = 0;
    const auto contours = section_contours(grid, slice);
    ASSERT_EQ(contours.size(), 2U);
    EXPECT_NE(contours[0].hole, contours[1].hole);
    for (const Contour& contour : contours)
        for (const Vec3& p : contour.points) {
            EXPECT_NEAR(p.x, 5, 1e-12);
            EXPECT_NEAR(contour.plane.distance_to(p), 0, 1e-12);
        }
}

/// The area between a section's outlines, in voxels of 1 mm.
double area_of(const PaintedSlice& slice, const Grid& grid) {
    double sum = 0;
    for (const Contour& contour : section_contours(grid, slice)) {
        double twice = 0;
        for (std::size_t n = 0; n < contour.points.size(); ++n) {
            const Vec3 &a = contour.points[n], &b = contour.points[(n + 1) % contour.points.size()];
            twice += a.x * b.y - b.x * a.y;
        }
        sum += contour.hole ? -std::abs(twice) / 2 : std::abs(twice) / 2;
    }
    return sum;
}

TEST(SectionContours, SmoothingLeavesThinPartsAndHolesTheirWidth) {
    const Grid grid = index_grid({30, 30, 1});
    const auto area = [&](const std::function<bool(const Index3&)>& painted) {
        return area_of(section_where(grid, painted), grid);
    };
    const auto is_in = [](const Index3& at, std::int64_t width, std::int64_t height) {
        return at.i >= 12 && at.i < 12 + width && at.j >= 12 && at.j < 12 + height;
    };
    EXPECT_GT(area([&](const Index3& at) { return is_in(at, 1, 1); }), 0.5);
    EXPECT_GT(area([&](const Index3& at) { return is_in(at, 6, 1); }), 5);
    EXPECT_GT(area([&](const Index3& at) { return is_in(at, 2, 2); }), 3.4);
    const auto is_in_square = [](const Index3& at) { return at.i >= 6 && at.i < 26 && at.j >= 6 && at.j < 26; };
    EXPECT_GT(area(is_in_square) - area([&](const Index3& at) { return is_in_square(at) && !is_in(at, 1, 1); }), 0.5);
}

TEST(SectionContours, VoxelsOfAThinPartThatTouchAtACornerAreOne) {
    const Grid grid = index_grid({12, 12, 1});
    const PaintedSlice slice = section_where(grid, [](const Index3& at) { return at.i == at.j && at.i > 3 && at.i < 8; });
    EXPECT_EQ(section_contours(grid, slice).size(), 1U);
}

}  // namespace
}  // namespace kontur
