// SPDX-License-Identifier: Apache-2.0
// Real series and structure sets, against the masks that came with them and against pydicom.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "kontur/base/error.h"
#include "kontur/extract/rasterize.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/images/nifti.h"
#include "support/run_python.h"
#include "support/test_data.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

struct Sarcoma {
    const char* folder;
    const char* mask;
    std::size_t contours;  ///< 47 stored, one of which is a keyhole, make 48
};

std::ostream& operator<<(std::ostream& out, const Sarcoma& sarcoma) { return out << sarcoma.folder; }

class SarcomaSeries : public testing::TestWithParam<Sarcoma> {
protected:
    fs::path folder() const { return test::data_dir() / GetParam().folder; }
};

TEST_P(SarcomaSeries, RasterizedStructureSetEqualsTheSuppliedMask) {
    KONTUR_REQUIRE_DATA(GetParam().folder);
    const Roi roi = select_roi(read_rtstruct(folder() / "RTSTRUCT_RS.dcm"));
    EXPECT_EQ(roi.contours.contours.size(), GetParam().contours);
    EXPECT_EQ(roi.contours.attributes.interpreted_type, "GTV");
    EXPECT_NO_THROW(check_contours(roi.contours));
    const Grid grid = read_dicom_grid(folder() / "image").grid;
    const Image supplied = read_nifti(folder() / GetParam().mask);
    EXPECT_LT(corner_distance_mm(grid, supplied.grid), 0.005);
    EXPECT_EQ(rasterize(roi.contours, grid).values, select_nonzero(supplied).values);
}

TEST_P(SarcomaSeries, SliceSumsAgreeWithPydicom) {
    KONTUR_REQUIRE_DATA(GetParam().folder);
    const DicomVolume volume = read_dicom_series(folder() / "image");
    const auto oracle = test::run_python("sum_dicom_slices.py", {(folder() / "image").string()});
    ASSERT_EQ(oracle.exit_code, 0) << oracle.output;
    std::istringstream sums(oracle.output);
    const Grid& grid = volume.image.grid;
    for (std::int64_t k = 0; k < grid.size.k; ++k) {
        double expected = 0, sum = 0, magnitude = 0;
        ASSERT_TRUE(sums >> expected);
        for (std::size_t n = grid.offset(0, 0, k); n < grid.offset(0, 0, k + 1); ++n) {
            sum += sample(volume.image, n);
            magnitude += std::abs(sample(volume.image, n));
        }
        ASSERT_NEAR(sum, expected, 1e-7 * magnitude) << "slice " << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Real, SarcomaSeries,
                         testing::Values(Sarcoma{"03_sarcoma_STS_002/CT", "CT_mask.nii.gz", 16},
                                         Sarcoma{"03_sarcoma_STS_002/MR_T1", "MR_T1_mask.nii.gz", 16},
                                         Sarcoma{"03_sarcoma_STS_002/PET", "PET_mask.nii.gz", 16},
                                         Sarcoma{"04_sarcoma_STS_040/CT", "CT_mask.nii.gz", 48},
                                         Sarcoma{"04_sarcoma_STS_040/MR_T1", "MR_T1_mask.nii.gz", 48},
                                         Sarcoma{"05_sarcoma_STS_008/CT", "CT_mask.nii.gz", 19},
                                         Sarcoma{"05_sarcoma_STS_008/MR_T1", "MR_T1_mask.nii.gz", 19}));

TEST(DicomReal, PetWithASlopePerFileIsFloat) {
    KONTUR_REQUIRE_DATA("03_sarcoma_STS_002/PET/image");
    const DicomVolume volume = read_dicom_series(test::data_dir() / "03_sarcoma_STS_002/PET/image");
    EXPECT_TRUE(std::holds_alternative<std::vector<float>>(volume.image.samples));
    EXPECT_EQ(volume.series.modality, "PT");
}

TEST(DicomReal, MissingSlicesAreNamed) {
    KONTUR_REQUIRE_DATA("15_synthetic_missing_slices_ct/dicom");
    try {
        read_dicom_series(test::data_dir() / "15_synthetic_missing_slices_ct/dicom");
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::unsupported);
        EXPECT_NE(std::string_view(error.what())
                      .find("slices are missing between z = 358.302 and 364.302, 379.302 and 388.302, 403.302 and "
                            "409.302 mm: 4 of them at the usual spacing of 3 mm; "),
                  std::string_view::npos)
            << error.what();
    }
}

/// The cine's slices are stored against row x column direction; NIfTI keeps that order, a stack read here ascends.
TEST(DicomReal, CineFramesLieWhereTheNiftiOfTheSameExamPutsThem) {
    KONTUR_REQUIRE_DATA("10_cine_mr_SC-HF-I-1/dicom_contoured_frames");
    const fs::path folder = test::data_dir() / "10_cine_mr_SC-HF-I-1";
    EXPECT_THROW(read_dicom_series(folder / "dicom_contoured_frames"), Error) << "two phases";
    struct Phase {
        int volume;
        std::int64_t nifti_frame;
    };
    for (const Phase phase : {Phase{1, 8}, Phase{2, 19}}) {
        const DicomVolume stack = read_dicom_series(folder / "dicom_contoured_frames", {.volume = phase.volume});
        const Image crop = read_nifti(folder / "cine4d_crop.nii.gz", {.frame = phase.nifti_frame, .prefer = {}});
        ASSERT_EQ(stack.image.grid.size, (Index3{256, 256, 9}));
        EXPECT_GT(stack.image.grid.index_to_mm.determinant(), 0);
        EXPECT_LT(crop.grid.index_to_mm.determinant(), 0);
        const Affine3 mm_to_index = stack.image.grid.index_to_mm.inverse();
        for (std::int64_t k = 2; k <= 10; ++k)
            for (std::int64_t j = 0; j < crop.grid.size.j; ++j)
                for (std::int64_t i = 0; i < crop.grid.size.i; ++i) {
                    const Vec3 index = mm_to_index.apply(crop.grid.center_mm(i, j, k));
                    const Vec3 nearest{std::round(index.x), std::round(index.y), std::round(index.z)};
                    ASSERT_LT(distance(index, nearest), 0.005);
                    const Index3 at{std::lround(index.x), std::lround(index.y), std::lround(index.z)};
                    ASSERT_EQ(sample(stack.image, stack.image.grid.offset(at.i, at.j, at.k)),
                              sample(crop, crop.grid.offset(i, j, k)));
                }
    }
}

TEST(DicomReal, SeriesBesidesOtherFilesIsFound) {
    KONTUR_REQUIRE_DATA("09_rtstruct_breast_dicompyler");
    const DicomGrid grid = read_dicom_grid(test::data_dir() / "09_rtstruct_breast_dicompyler");
    EXPECT_EQ(grid.grid.size, (Index3{512, 512, 1}));
    EXPECT_EQ(grid.notes.back(), "a single slice; its depth of 3 mm is its SliceThickness");
    const DicomGrid three = read_dicom_grid(test::data_dir() / "14_dicom_seg_dcmqi/ct-3slice");
    EXPECT_NEAR(three.grid.spacing_mm().z, 1.0, 1e-9) << "the step between slices, not their thickness of 1.25 mm";
}

}  // namespace
}  // namespace kontur
