// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "kontur/io/contour_json.h"
#include "kontur/segment.h"
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

INSTANTIATE_TEST_SUITE_P(Segment, RealSetLeakTest,
                         testing::Values("lateral_ventricles/ortho3x3.json", "lateral_ventricles/radial6.json",
                                         "lateral_ventricles/tilted_parallel7.json", "hippocampus_label5/oblique10.json",
                                         "kidney_right_5mm/ortho3x3_handdrawn.json", "vertebral_body_L5label/radial6.json"));

}  // namespace
}  // namespace kontur
