// SPDX-License-Identifier: Apache-2.0
// Moving, turning and scaling the contours and the grid together changes nothing: from objects of 1 um to objects of 100 m.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "kontur/phantom/cases.h"
#include "kontur/segment.h"
#include "support/coarse_grid.h"
#include "support/contour_sets.h"
#include "support/functions.h"

namespace kontur {
namespace {

struct Drawing {
    ContourSet contours;
    Grid grid;
};

/// Made by the test that needs it: the program of all tests starts often.
struct Drawn {
    std::string name;
    std::function<Drawing()> draw;
};

void PrintTo(const Drawn& drawn, std::ostream* out) { *out << drawn.name; }

ContourSet moved(ContourSet set, const Affine3& turn, const Vec3& shift, double scale) {
    const auto move = [&](const Vec3& p) { return shift + scale * turn.apply(p); };
    for (Contour& contour : set.contours) {
        for (Vec3& p : contour.points) p = move(p);
        // As a file gives it: with axes of its own choice.
        contour.plane = make_plane(move(contour.plane.origin), turn.apply(contour.plane.normal));
    }
    for (Vec3& p : set.interior) p = move(p);
    for (Vec3& p : set.exterior) p = move(p);
    for (Plane& plane : set.empty_planes) plane = make_plane(move(plane.origin), turn.apply(plane.normal));
    return set;
}

Grid moved(const Grid& grid, const Affine3& turn, const Vec3& shift, double scale) {
    Affine3 motion = turn;
    for (auto& row : motion.linear)
        for (double& entry : row) entry *= scale;
    motion.translation = shift;
    return {grid.size, compose(motion, grid.index_to_mm)};
}

Affine3 rotation(const Vec3& normal) {
    const Plane frame = make_plane({}, normal);
    Affine3 turn;
    turn.set_column(0, frame.u);
    turn.set_column(1, frame.v);
    turn.set_column(2, frame.normal);
    return turn;
}

Drawn of_phantom(const std::string& name, std::int64_t step) {
    return {name, [=] {
                const PhantomCase drawn = phantom_case(name);
                return Drawing{drawn.contours, test::coarse(drawn.grid, step)};
            }};
}

/// Circles of a ball of 20 mm in parallel planes, with a click inside and one outside.
Drawing ball(const std::vector<double>& heights) {
    Drawing drawing{{}, test::grid_about({}, {56, 56, 56}, 1.25)};  // no end is near the border
    for (const double z : heights)
        drawing.contours.contours.push_back(test::circle(make_plane({0, 0, z}, {0, 0, 1}), std::sqrt(400 - z * z), 60));
    drawing.contours.interior = {{0, 0, 1}};
    drawing.contours.exterior = {{0, 0, 24}};
    drawing.contours.empty_planes = {make_plane({0, 0, -22}, {0, 0.1, 1})};
    return drawing;
}

std::size_t different_voxels(const Mask& a, const Mask& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) count += a.values[i] != b.values[i];
    return count;
}

Segmentation moved_and_segmented(const Drawing& drawing, const Affine3& turn, const Vec3& shift, double scale) {
    return segment(moved(drawing.contours, turn, shift, scale), moved(drawing.grid, turn, shift, scale));
}

class Equivariance : public testing::TestWithParam<Drawn> {};

TEST_P(Equivariance, MasksScaleWithTheContoursFromMicrometresToAHundredMetres) {
    const Drawing drawing = GetParam().draw();
    const Segmentation original = segment(drawing.contours, drawing.grid);
    ASSERT_GT(original.report.mask_voxels, 1000);
    Affine3 axes_exchanged;
    axes_exchanged.linear = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
    for (const double scale : {1e-5, 1e-3, 1.0, 1e3}) {
        const Segmentation result = moved_and_segmented(drawing, axes_exchanged, scale * Vec3{70, -200, 900}, scale);
        // Voxels whose centres lie on the surface to within the solver's tolerance and rounding.
        EXPECT_LE(different_voxels(original.mask, result.mask), static_cast<std::size_t>(original.report.mask_voxels / 2000))
            << "scaled by " << scale;
        EXPECT_NEAR(result.report.residual.max_mm / scale, original.report.residual.max_mm,
                    0.02 * original.report.residual.max_mm + 1e-3);
        EXPECT_EQ(result.report.warnings.size(), original.report.warnings.size()) << "scaled by " << scale;
    }
}

TEST_P(Equivariance, MasksTurnWithTheContours) {
    const Drawing drawing = GetParam().draw();
    const Segmentation original = segment(drawing.contours, drawing.grid);
    for (const Vec3& axis : {Vec3{0.3, -0.5, 0.8}, Vec3{-1, 1, 0.2}}) {
        const Segmentation result = moved_and_segmented(drawing, rotation(axis), {70, -200, 900}, 1);
        EXPECT_LE(different_voxels(original.mask, result.mask),
                  static_cast<std::size_t>(original.report.mask_voxels / 1000));
        EXPECT_NEAR(result.report.residual.max_mm, original.report.residual.max_mm,
                    0.02 * original.report.residual.max_mm + 1e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(Drawings, Equivariance,
                         testing::Values(Drawn{"ball3",
                                               [] {
                                                   return ball({-12, 0, 9});
                                               }},
                                         Drawn{"ball1", [] { return ball({3}); }}, of_phantom("metastasis_parallel7", 3),
                                         of_phantom("kidney_radial6_hand", 2), of_phantom("vertebra_parallel11_hand", 3),
                                         of_phantom("liver_oblique10_hand", 6)),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace kontur
