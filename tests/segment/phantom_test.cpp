// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "kontur/phantom/cases.h"
#include "kontur/segment.h"
#include "support/coarse_grid.h"

namespace kontur {
namespace {

std::vector<std::uint8_t> true_mask(const Body& body, const Grid& grid) {
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(grid.voxel_count()));
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                mask[grid.offset(i, j, k)] = body.value(grid.center_mm(i, j, k)) > 0;
    return mask;
}

/// Dice against the analytic body, on every `coarsening`-th voxel.
double dice(const std::string& name, std::int64_t coarsening, const SegmentOptions& options = {}) {
    const PhantomCase c = phantom_case(name);
    const Grid grid = test::coarse(c.grid, coarsening);
    const Segmentation result = segment(c.contours, grid, options);
    return test::dice(result.mask.values, true_mask(*c.body, grid));
}

/// Fewer points than the case has, to be quick.
SegmentOptions reduced() {
    SegmentOptions options;
    options.quality = 0.4;
    return options;
}

TEST(Phantom, LiverFromOrthogonalContoursWithSurfaceNormals) { EXPECT_GT(dice("liver_orthogonal14", 4, reduced()), 0.998); }

TEST(Phantom, LiverFromOrthogonalContoursLeaksAsPrinted) {
    // Where contours of different planes cross, their in-plane normals contradict each other.
    SegmentOptions options = reduced();
    options.kernel = Kernel::triharmonic;
    options.normals = Normals::in_plane;
    options.normal_offset_mm = 1;
    options.smoothing = 0;
    EXPECT_LT(dice("liver_orthogonal14", 4, options), 0.95);
}

TEST(Phantom, MetastasisFromSevenOfItsContours) { EXPECT_GT(dice("metastasis_parallel7", 2), 0.998); }

// Beyond its wide flat ends the next plane shows its processes alone: bounds must neither dent nor bend them.
TEST(Phantom, VertebraWithItsFlatEnds) {
    EXPECT_GT(dice("vertebra_parallel11", 2), 0.99);
    EXPECT_GT(dice("vertebra_parallel11_hand", 2), 0.975);
}

TEST(Phantom, ContoursDrawnByAnUnsteadyHand) {
    EXPECT_GT(dice("metastasis_parallel7_hand", 2), 0.985);
    EXPECT_GT(dice("kidney_radial6_hand", 2), 0.97);
    EXPECT_GT(dice("liver_orthogonal14_hand", 4, reduced()), 0.987);
    EXPECT_GT(dice("liver_parallel14_hand", 4, reduced()), 0.989);
    EXPECT_GT(dice("liver_oblique10_hand", 2, reduced()), 0.98);
}

}  // namespace
}  // namespace kontur
