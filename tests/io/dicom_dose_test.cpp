// SPDX-License-Identifier: Apache-2.0
// Dose grids (RTDOSE) as images.
#include <gtest/gtest.h>

#include "support/dicom_series_fixture.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

using test::has_samples;
using test::notes_mention;

class DicomDoseTest : public test::DicomSeriesTest {
protected:
    fs::path make_dose(const std::string& name) { return make(name, "make_rtdose.py"); }
};

TEST_F(DicomDoseTest, HasTheDoseAndThePlaceThatPydicomReads) {
    for (const char* name : {"relative", "absolute", "descending", "oblique", "byte", "single"}) {
        SCOPED_TRACE(name);
        make_dose(name);
        const DicomVolume dose = check(name);
        EXPECT_TRUE(has_samples<float>(dose));
        EXPECT_EQ(dose.series.modality, "RTDOSE");
        EXPECT_TRUE(notes_mention(dose.notes, "a dose; its unit is GY"));
    }
}

TEST_F(DicomDoseTest, IsLeftOutBesideImagesUnlessItIsNamed) {
    const fs::path files = make("axial");
    const fs::path dose = make_dose("relative") / "dose0.dcm";
    fs::copy_file(dose, files / "dose.dcm");
    EXPECT_TRUE(notes_mention(check("axial").notes, "left out 1 file (RTDOSE): dose.dcm"));
    const Grid grid = read_dicom_grid(dose).grid;
    EXPECT_EQ(read_dicom_grid(files / "dose.dcm").grid, grid);
    const auto all = list_dicom_series(files);
    ASSERT_EQ(all.size(), 2u);
    const DicomSeries& listed = all[0].modality == "RTDOSE" ? all[0] : all[1];
    EXPECT_EQ(read_dicom_grid(files, {.series_uid = listed.series_uid}).grid, grid);
}

TEST_F(DicomDoseTest, ImagesBelowAFolderWithADoseAreFound) {
    const fs::path files = make("axial");
    const Grid grid = read_dicom_grid(files).grid;
    fs::copy_file(make_dose("relative") / "dose0.dcm", files.parent_path() / "dose.dcm");
    EXPECT_EQ(read_dicom_grid(files.parent_path()).grid, grid);
}

TEST_F(DicomDoseTest, SeveralGridsOfOneSeriesAreVolumes) {
    const fs::path files = make_dose("two");
    EXPECT_REFUSED(refusal(files), invalid_input, "several volumes; choose one with the option volume: ");
    EXPECT_REFUSED(refusal(files), invalid_input, "dose PHYSICAL PLAN in dose1.dcm");
    const DicomVolume second = read_dicom_series(files / "dose1.dcm");
    EXPECT_EQ(second.series.files.front().filename(), "dose1.dcm");
    EXPECT_EQ(second.image.grid.size.k, 6);
}

TEST_F(DicomDoseTest, RefusesContradictoryGrids) {
    EXPECT_REFUSED(refusal(make_dose("irregular")), unsupported, "the slice spacing is irregular");
    EXPECT_REFUSED(refusal(make_dose("short")), corrupt_file,
                   "it has 6 frames, and GridFrameOffsetVector (3004,000c) has 5");
    EXPECT_REFUSED(refusal(make_dose("neither")), corrupt_file, "begins neither with 0 nor with the z of an axial plane");
    EXPECT_REFUSED(refusal(make_dose("unscaled")), corrupt_file, "DoseGridScaling (3004,000e) is missing or not positive");
}

}  // namespace
}  // namespace kontur
