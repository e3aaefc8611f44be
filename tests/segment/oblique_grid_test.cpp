// SPDX-License-Identifier: Apache-2.0
// Geometry from end to end: a real mask on a grid that no one would choose, cut by planes along none of its axes, and
// segmented on that grid again.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "kontur/extract/trace.h"
#include "kontur/io/image.h"
#include "kontur/measure/compare.h"
#include "kontur/segment.h"
#include "support/test_data.h"

namespace kontur {
namespace {

/// `count` planes along each of three oblique directions at right angles, evenly over the box.
std::vector<Plane> oblique_planes(const Box3& box, int count) {
    const Vec3 normals[] = {normalized({2, 1, 2}), normalized({-2, 2, 1}), normalized({1, 2, -2})};
    std::vector<Plane> planes;
    for (const Vec3& normal : normals) {
        const double extent =
            std::abs(normal.x) * box.size().x + std::abs(normal.y) * box.size().y + std::abs(normal.z) * box.size().z;
        for (int p = 0; p < count; ++p)
            planes.push_back(make_plane(box.center() + extent * ((p + 0.5) / count - 0.5) * normal, normal));
    }
    return planes;
}

struct Case {
    const char* name;
    const char* path;
    double angle_degrees;  ///< between the grid's j and k axes
    double handedness;     ///< sign of its determinant
    double dice;           ///< lower bound, a little below what was measured
    friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

class ObliqueGrid : public testing::TestWithParam<Case> {};

TEST_P(ObliqueGrid, GivesTheMaskBackThatWasTraced) {
    KONTUR_REQUIRE_DATA(GetParam().path);
    const Mask truth = read_mask(test::data_dir() / GetParam().path);
    const Affine3& axes = truth.grid.index_to_mm;
    const double angle = std::acos(dot(normalized(axes.column(1)), normalized(axes.column(2)))) * 180 / M_PI;
    ASSERT_NEAR(angle, GetParam().angle_degrees, 0.1);
    ASSERT_EQ(std::copysign(1.0, axes.determinant()), GetParam().handedness);
    // Threshold masks are frayed: neither specks nor voxel steps are worth a contour's points.
    const TraceOptions tracing{.step_mm = 0, .tolerance_mm = 0.4, .min_area_mm2 = 20};
    const ContourSet contours = trace(truth, oblique_planes(bounding_box(truth), 12), tracing);
    const Mask mask = segment(contours, truth.grid).mask;
    const Comparison found = compare(mask, truth);
    std::cout << "measured: Dice " << found.dice << "\n";
    EXPECT_GE(found.dice, GetParam().dice) << "mask " << found.volume_a_ml << " ml, truth " << found.volume_b_ml << " ml";
}

INSTANTIATE_TEST_SUITE_P(
    RealMasks, ObliqueGrid,
    testing::Values(Case{"sheared", "12_ct_head_gantry_tilt_shear/shear_insert_threshold_mask.nii.gz", 71.5, 1, 0.925},
                    Case{"tilted", "12_ct_head_gantry_tilt_shear/CT_pitch_insert_threshold_mask.nii.gz", 90, 1, 0.935},
                    Case{"left_handed", "10_cine_mr_SC-HF-I-1/mask_ED_epi.nii.gz", 90, -1, 0.985}));

}  // namespace
}  // namespace kontur
