// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kontur/io/images/nifti.h"
#include "support/test_data.h"

namespace kontur::viewer {
namespace {

/// A grid whose axes i, j, k run along the patient's axes `order` with `signs`, tilted by a few degrees.
Grid oriented(const std::array<int, 3>& order, int signs) {
    const Vec3 spacing{0.8, 1.1, 3};
    Grid grid{{20, 30, 12}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 column;
        column[order[axis]] = (signs >> axis & 1) ? -spacing[axis] : spacing[axis];
        const Vec3 tilted{column.x - 0.1 * column.y, column.y + 0.1 * column.x, column.z};
        grid.index_to_mm.set_column(axis, tilted / std::sqrt(column.z == 0 ? 1.01 : 1.0));
    }
    grid.index_to_mm.translation = {5, -80, 300};
    return grid;
}

TEST(ViewOf, ShowsAll48OrientationsTheRadiologicalWayRound) {
    std::array<int, 3> order{0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            const Grid grid = oriented(order, signs);
            for (const SliceKind kind : {SliceKind::axial, SliceKind::coronal, SliceKind::sagittal}) {
                const View view = view_of(grid, kind);
                const Plane screen = screen_plane(kind, {});
                EXPECT_GT(dot(view.plane.u, screen.u), 0.98);
                EXPECT_GT(dot(view.plane.v, screen.v), 0.98);
                EXPECT_GT(dot(view.plane.normal, screen.normal), 0.98);
                EXPECT_NEAR(dot(view.plane.u, view.plane.v), 0, 1e-12);
                EXPECT_NEAR(dot(cross(view.plane.u, view.plane.v), view.plane.normal), 1, 1e-12);
            }
        }
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(ViewOf, StepsThroughEverySliceOfTheImage) {
    const Grid grid = oriented({0, 1, 2}, 0);
    const View axial = view_of(grid, SliceKind::axial);
    EXPECT_NEAR(axial.step_mm, 3, 1e-12);
    EXPECT_NEAR((axial.to_mm - axial.from_mm) / axial.step_mm, 11, 1e-9);
    const View coronal = view_of(grid, SliceKind::coronal);
    EXPECT_NEAR(coronal.step_mm, 1.1, 1e-9);
    EXPECT_NEAR((coronal.to_mm - coronal.from_mm) / coronal.step_mm, 29, 1e-9);
    EXPECT_NEAR(axial.width_mm, 16, 1e-9);
    EXPECT_NEAR(axial.height_mm, 33, 1e-9);
}

/// Turned about the patient's first axis.
Grid turned(double degrees, const Vec3& spacing) {
    const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
    Grid grid{{20, 30, 12}, {}};
    grid.index_to_mm.set_column(0, {spacing.x, 0, 0});
    grid.index_to_mm.set_column(1, Vec3{0, c, s} * spacing.y);
    grid.index_to_mm.set_column(2, Vec3{0, -s, c} * spacing.z);
    return grid;
}

TEST(ViewNames, AreAnatomicalWithin20DegreesOfThePatientsAxes) {
    for (const double degrees : {-19.5, 0.0, 19.5, 70.5, 90.0, 180.0}) {
        const ViewNames names = view_names(turned(degrees, {1, 1, 3}));
        EXPECT_EQ(names.titles, (std::array<std::string, 3>{"Axial", "Sagittal", "Coronal"})) << degrees;
        EXPECT_EQ(names.first, SliceKind::axial);
    }
}

TEST(ViewNames, OfObliqueImagesAreTheAcquisitions) {
    const ViewNames low = view_names(turned(30, {1, 1, 3}));  // the slices are nearer to axial than to coronal ones
    EXPECT_EQ(low.first, SliceKind::axial);
    EXPECT_EQ(low.titles, (std::array<std::string, 3>{"Acquisition", "Column", "Row"}));
    const ViewNames steep = view_names(turned(60, {1, 1, 3}));
    EXPECT_EQ(steep.first, SliceKind::coronal);
    EXPECT_EQ(steep.titles, (std::array<std::string, 3>{"Row", "Column", "Acquisition"}));
}

TEST(ViewNames, TakeTheAxisWithTheLargestSpacingForThatOfTheSlices) {
    EXPECT_EQ(view_names(turned(30, {3, 1, 1})).first, SliceKind::sagittal);
    EXPECT_EQ(view_names(turned(30, {1, 3, 1})).first, SliceKind::coronal);
    EXPECT_EQ(view_names(turned(30, {1, 1.1, 1})).first, SliceKind::axial);
}

TEST(ViewNames, OfACineInShortAxisBeginWithItsSlices) {
    KONTUR_REQUIRE_DATA("10_cine_mr_SC-HF-I-1/cine4d_crop.nii.gz");
    const Image cine = read_nifti(test::data_dir() / "10_cine_mr_SC-HF-I-1/cine4d_crop.nii.gz", {.frame = 1, .prefer = {}});
    const ViewNames names = view_names(cine.grid);
    EXPECT_EQ(names.titles[static_cast<std::size_t>(names.first)], "Acquisition");
    EXPECT_NEAR(view_of(cine.grid, names.first).step_mm, 10, 1e-3);
}

TEST(ViewOf, AShearedGridIsShownInItsOwnSlices) {
    Grid grid{{20, 20, 10}, {}};
    grid.index_to_mm.set_column(2, {0, 0.8, 3});  // a tilted gantry
    const View axial = view_of(grid, SliceKind::axial);
    EXPECT_NEAR(axial.plane.normal.z, 1, 1e-12);
    EXPECT_NEAR(axial.step_mm, 3, 1e-12);
}

TEST(ObliqueView, IsParallelToNoAxisOfTheImage) {
    const Grid grid = oriented({2, 0, 1}, 5);
    const View view = oblique_view(grid);
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 direction = normalized(grid.index_to_mm.column(axis));
        EXPECT_NEAR(std::abs(dot(view.plane.normal, direction)), std::abs(direction.z) > 0.5 ? 0 : 0.7071, 1e-3);
    }
    EXPECT_NEAR(dot(cross(view.plane.u, view.plane.v), view.plane.normal), 1, 1e-12);
    EXPECT_NEAR(view.step_mm, 0.8, 1e-9);
}

TEST(WindowPresets, AreThoseOfCtOnlyForCt) {
    const Grid grid{{4, 4, 4}, {}};
    std::vector<std::int16_t> hu(64, -1000);
    hu[5] = 60;
    EXPECT_EQ(window_presets({grid, hu}).front().name, "Abdomen");
    EXPECT_EQ(window_presets({grid, std::vector<std::uint8_t>(64, 9)}).front().name, "Automatic");
    for (const WindowPreset& preset : window_presets({grid, std::vector<float>(64, 7.f)})) EXPECT_GT(preset.window.width, 0);
}

}  // namespace
}  // namespace kontur::viewer
