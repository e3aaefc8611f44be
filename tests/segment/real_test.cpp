// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kontur/extract/rasterize.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"
#include "kontur/segment.h"
#include "kontur/shape/section.h"
#include "support/coarse_grid.h"
#include "support/test_data.h"

namespace kontur {
namespace {

/// Real structures cut by planes of five kinds, with the least Dice that default options must reach against the mask that
/// was cut.
struct RealSet {
    const char* structure;
    std::array<double, 5> least_dice;  ///< in the order of kPlanes
    friend std::ostream& operator<<(std::ostream& out, const RealSet& set) { return out << set.structure; }
};
constexpr const char* kPlanes[] = {"ortho3x3", "ortho3x3_handdrawn", "radial6", "oblique10", "tilted_parallel7"};
constexpr RealSet kSets[] = {
    {"hippocampus_label5", {0.937, 0.870, 0.970, 0.901, 0.960}},
    {"kidney_right_5mm", {0.964, 0.950, 0.967, 0.949, 0.953}},
    {"lateral_ventricles", {0.846, 0.823, 0.791, 0.847, 0.831}},
    {"liver_5mm", {0.955, 0.935, 0.961, 0.923, 0.933}},
    {"sarcoma_STS_040_CT", {0.967, 0.962, 0.969, 0.961, 0.956}},
    {"vertebral_body_L5label", {0.971, 0.943, 0.943, 0.961, 0.951}},
};

class RealContours : public testing::TestWithParam<RealSet> {};

TEST_P(RealContours, DefaultOptionsReachTheKnownAgreementFromEverySetOfPlanes) {
    const std::filesystem::path folder = test::data_dir() / "derived_nonparallel" / GetParam().structure;
    KONTUR_REQUIRE_DATA(std::filesystem::path("derived_nonparallel") / GetParam().structure);
    const Mask truth = read_mask(folder / "truth.nii.gz");
    for (std::size_t p = 0; p < std::size(kPlanes); ++p) {
        const ContourSet contours = read_contour_json(folder / (std::string(kPlanes[p]) + ".json"));
        const Segmentation result = segment(contours, truth.grid);
        const double agreement = test::dice(result.mask.values, truth.values);
        EXPECT_GT(agreement, GetParam().least_dice[p]) << kPlanes[p];
        EXPECT_LE(result.report.mask_components, static_cast<std::int64_t>(contours.contours.size())) << kPlanes[p];
        EXPECT_LT(result.report.residual.rms_mm, 0.5) << kPlanes[p];
        EXPECT_LT(result.report.iterations, 14 * result.report.solves) << kPlanes[p];
    }
}

/// A quarter of the points, so that it takes seconds; all of them: docs/accuracy/drawings.md.
Segmentation of_a_quarter(const ContourSet& contours, const Grid& grid) {
    SegmentOptions options;
    options.quality = 0.25;
    return segment(contours, grid, options);
}

TEST(RealBranches, ATumourOfSeveralContoursASliceIsOnePieceWithItsHoles) {
    KONTUR_REQUIRE_DATA("04_sarcoma_STS_040");
    const std::filesystem::path folder = test::data_dir() / "04_sarcoma_STS_040/CT";
    const ContourSet contours = select_roi(read_rtstruct(folder / "RTSTRUCT_RS.dcm")).contours;
    ASSERT_EQ(point_count(contours), 25540u);
    const Mask truth = read_mask(folder / "CT_mask.nii.gz");
    const Segmentation result = of_a_quarter(contours, truth.grid);
    EXPECT_GT(test::dice(result.mask.values, truth.values), 0.997);
    EXPECT_EQ(result.report.mask_components, 1);
    EXPECT_LT(result.report.iterations, 16 * result.report.solves);
}

TEST(RealBranches, ALungKeepsTheHolesOfItsVessels) {
    KONTUR_REQUIRE_DATA("09_rtstruct_breast_dicompyler");
    const std::filesystem::path file = test::data_dir() / "09_rtstruct_breast_dicompyler/rtss.dcm";
    const ContourSet contours = select_roi(read_rtstruct(file), "Lt Lung").contours;
    const auto holes = std::ranges::count_if(contours.contours, [](const Contour& c) { return c.hole; });
    EXPECT_GE(holes, 70);
    const Box3 box = bounding_box(contours);
    Grid grid;
    grid.size = {static_cast<std::int64_t>(box.size().x / 2) + 12, static_cast<std::int64_t>(box.size().y / 2) + 12,
                 std::lround(box.size().z / 3) + 5};
    grid.index_to_mm.linear = {{{2, 0, 0}, {0, 2, 0}, {0, 0, 3}}};
    grid.index_to_mm.translation = box.min - Vec3{12, 12, 6};
    const Mask truth = rasterize(contours, grid);
    const Segmentation result = of_a_quarter(contours, grid);
    EXPECT_GT(test::dice(result.mask.values, truth.values), 0.98);
    EXPECT_LT(result.report.iterations, 16 * result.report.solves);
}

/// The voxels of drawn slices that are on the wrong side of what was drawn there, and how far from the line the farthest is
/// of those that are missing.
struct WrongVoxels {
    std::int64_t drawn = 0, wrong = 0;
    double farthest_missing_mm = 0;
};

WrongVoxels wrong_on_drawn_slices(const ContourSet& contours, const Mask& mask) {
    const Mask drawn = rasterize(contours, mask.grid);
    const Affine3 to_index = mask.grid.index_to_mm.inverse();
    WrongVoxels result;
    for (const Section& section : sections_of(contours, 0.01)) {
        const std::int64_t k = std::lround(to_index.apply(section.plane.origin).z);
        for (std::int64_t j = 0; j < mask.grid.size.j; ++j)
            for (std::int64_t i = 0; i < mask.grid.size.i; ++i) {
                const std::size_t at = mask.grid.offset(i, j, k);
                result.drawn += drawn.values[at] != 0;
                if ((drawn.values[at] != 0) == (mask.values[at] != 0)) continue;
                ++result.wrong;
                const double off = section.clearance(section.plane.to_uv(mask.grid.center_mm(i, j, k)));
                if (drawn.values[at] != 0) result.farthest_missing_mm = std::max(result.farthest_missing_mm, off);
            }
    }
    return result;
}

// Where contours do not contradict each other, every slice that was given comes back, but for voxels that the tolerance
// decides.
TEST(RealBranches, GivenSlicesOfStructureSetsComeBackToTheVoxel) {
    for (const char* patient : {"03_sarcoma_STS_002", "05_sarcoma_STS_008"}) {
        KONTUR_REQUIRE_DATA(patient);
        const std::filesystem::path folder = test::data_dir() / patient / "CT";
        const ContourSet contours = select_roi(read_rtstruct(folder / "RTSTRUCT_RS.dcm")).contours;
        const Mask mask = segment(contours, read_mask(folder / "CT_mask.nii.gz").grid).mask;
        const WrongVoxels found = wrong_on_drawn_slices(contours, mask);
        EXPECT_GT(found.drawn, 8000) << patient;
        EXPECT_LE(found.wrong, found.drawn / 2000) << patient;
        EXPECT_LT(found.farthest_missing_mm, 0.2) << patient;
    }
}

INSTANTIATE_TEST_SUITE_P(, RealContours, testing::ValuesIn(kSets),
                         [](const auto& set) { return std::string(set.param.structure); });

}  // namespace
}  // namespace kontur
