// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_series.h"

#include "kontur/io/dicom/dicom_identity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "kontur/base/error.h"
#include "kontur/io/file_digest.h"
#include "support/damage.h"
#include "support/dicom_series_fixture.h"
#include "support/recompress.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

using test::DicomSeriesTest;
using test::has_samples;
using test::notes_mention;
using test::read_truth;
using test::Truth;

TEST_F(DicomSeriesTest, OrdersSlicesByPositionWhateverTheirNamesAndNumbers) {
    const DicomVolume volume = read_and_check("axial");
    EXPECT_TRUE(has_samples<std::int16_t>(volume));
    EXPECT_TRUE(volume.notes.empty());
    EXPECT_EQ(volume.series.modality, "CT");
    EXPECT_EQ(volume.series.files.size(), 9u);
}

TEST_F(DicomSeriesTest, SaysWhoseImageItIs) {
    const fs::path folder = make("axial");
    const DicomIdentity identity = dicom_identity(list_dicom_series(folder).front().files.front());
    EXPECT_EQ(identity.patient_name, "Phantom, One");
    EXPECT_EQ(identity.patient_id, "P1");
    EXPECT_EQ(identity.modality, "CT");
    EXPECT_EQ(identity.unit, "HU");
    EXPECT_EQ(identity.birth_date, "");
}

TEST_F(DicomSeriesTest, PlacesObliqueAndCoronalSlices) {
    read_and_check("oblique");
    read_and_check("coronal");
}

TEST_F(DicomSeriesTest, KeepsAGantryTiltAsExactShearAndSaysSo) {
    const DicomVolume volume = read_and_check("tilt");
    EXPECT_TRUE(notes_mention(volume.notes, "gantry tilt"));
    EXPECT_TRUE(notes_mention(volume.notes, "15 degrees"));
}

TEST_F(DicomSeriesTest, NamesTheGapsOfMissingSlices) {
    const Error error = refusal(make("missing"));
    EXPECT_EQ(error.kind(), ErrorKind::unsupported);
    EXPECT_NE(
        std::string(error.what())
            .find("slices are missing between z = 105 and 112.5, 115 and 120 mm: 3 of them at the usual spacing of 2.5 mm"),
        std::string::npos)
        << error.what();
}

TEST_F(DicomSeriesTest, CountsMissingSlicesBeyondEveryInteger) {
    EXPECT_REFUSED(refusal(make("far")), unsupported, ": 4e+24 of them at the usual spacing of 2.5 mm");
}

TEST_F(DicomSeriesTest, ReadsPositionsThatAreRoundedAsTheyAreWrittenWithTheLargestDeviation) {
    const DicomVolume volume = read_dicom_series(make("rounded"));
    EXPECT_NEAR(norm(volume.image.grid.index_to_mm.column(2)), 2.53, 0.02);
    EXPECT_TRUE(notes_mention(volume.notes, "the slices' positions are rounded: they lie up to 0.0625 mm off"))
        << testing::PrintToString(volume.notes);
    EXPECT_REFUSED(refusal(make("rounded_missing")), unsupported, "slices are missing between z = 100 and");
}

TEST_F(DicomSeriesTest, NamesTheWayOutOfIrregularSlices) {
    EXPECT_REFUSED(refusal(make("missing")), unsupported,
                   "resample_slices interpolates slices, and kontur segment --spacing-mm needs no image");
}

TEST_F(DicomSeriesTest, ResampledSlicesAreThoseThatAreThereAndLieBetweenThemElsewhere) {
    const fs::path files = make("missing");  // 3, 4 and 7 of nine
    const DicomSeriesOptions options{.resample_slices = true};
    const DicomVolume volume = read_dicom_series(files, options);
    const Truth truth = read_truth(folder_ / "missing");
    EXPECT_LT(corner_distance_mm(volume.image.grid, truth.grid), 1e-5);
    EXPECT_EQ(read_dicom_grid(files, options).grid, volume.image.grid);
    EXPECT_EQ(volume.series.files.size(), 6u);
    EXPECT_TRUE(has_samples<std::int16_t>(volume));
    EXPECT_TRUE(notes_mention(volume.notes, "resampled to steps of 2.5 mm: 3 of 9 slices are interpolated"))
        << testing::PrintToString(volume.notes);
    const auto expected = [&](std::size_t k, std::size_t n) {
        const auto at = [&](std::size_t slice) { return truth.values[slice * 14 * 12 + n]; };
        if (k == 3) return std::round((2 * at(2) + at(5)) / 3);
        if (k == 4) return std::round((at(2) + 2 * at(5)) / 3);
        if (k == 7) return std::round((at(6) + at(8)) / 2);
        return at(k);
    };
    for (std::size_t k = 0; k < 9; ++k)
        for (std::size_t n = 0; n < 14 * 12; ++n)
            ASSERT_NEAR(sample(volume.image, k * 14 * 12 + n), expected(k, n), 1e-9) << k << " " << n;
}

TEST_F(DicomSeriesTest, ASliceOffItsPlaceIsInterpolatedThereAndNoOtherSliceChanges) {
    const fs::path files = make("jitter");  // slice 4 lies 0.2 mm too high
    const DicomVolume volume = read_dicom_series(files, {.resample_slices = true});
    const Truth truth = read_truth(folder_ / "jitter");
    EXPECT_TRUE(notes_mention(volume.notes, "2.3 to 2.7 mm apart and are resampled to steps of 2.5 mm: 1 of 9 slices"))
        << testing::PrintToString(volume.notes);
    for (std::size_t n = 0; n < truth.values.size(); ++n) {
        const bool is_moved = n / (14 * 12) == 4;
        const double below = is_moved ? truth.values[n - 14 * 12] : 0;
        const double expected = is_moved ? std::round(below + (truth.values[n] - below) * 2.5 / 2.7) : truth.values[n];
        ASSERT_NEAR(sample(volume.image, n), expected, 1e-9) << n;
    }
}

TEST_F(DicomSeriesTest, EvenSlicesAreNotResampled) {
    EXPECT_TRUE(read_and_check("axial", {.resample_slices = true}).notes.empty());
    read_and_check("tilt", {.resample_slices = true});
    EXPECT_REFUSED(refusal(make("shifted"), {.resample_slices = true}), unsupported, "is shifted by 0.5 mm");
    EXPECT_REFUSED(refusal(make("far"), {.resample_slices = true}), unsupported, "slices are missing between");
}

TEST_F(DicomSeriesTest, RefusesIrregularSpacingAndShift) {
    EXPECT_REFUSED(refusal(make("jitter")), unsupported, "steps from 2.3 to 2.7 mm put slices up to 0.2 mm off");
    EXPECT_REFUSED(refusal(make("shifted")), unsupported, "the slice at z = 110 mm is shifted by 0.5 mm");
}

TEST_F(DicomSeriesTest, AppliesTheRescaleOfEachFile) {
    EXPECT_TRUE(has_samples<float>(read_and_check("fraction")));
    EXPECT_TRUE(has_samples<float>(read_and_check("slopes")));
}

TEST_F(DicomSeriesTest, ReadsEveryStoredSampleLayoutIntoTheNarrowestType) {
    EXPECT_TRUE(has_samples<std::int16_t>(read_and_check("masked")));
    EXPECT_TRUE(has_samples<std::uint8_t>(read_and_check("bytes")));
    EXPECT_TRUE(has_samples<std::uint16_t>(read_and_check("unsigned")));
    EXPECT_TRUE(has_samples<std::int32_t>(read_and_check("wide")));
}

TEST_F(DicomSeriesTest, ReadsEveryUncompressedAndRunLengthEncoding) {
    for (const char* syntax : {"implicit", "big_endian", "deflated", "rle"}) {
        SCOPED_TRACE(syntax);
        read_and_check(syntax);
    }
}

TEST_F(DicomSeriesTest, ReadsJpegJpegLsAndJpeg2000) {
    for (const char* name : {"axial", "bytes", "unsigned", "enhanced"})
        for (const E_TransferSyntax syntax : {EXS_JPEGProcess14SV1, EXS_JPEGLSLossless, EXS_JPEG2000LosslessOnly}) {
            SCOPED_TRACE(std::string(name) + " in " + DcmXfer(syntax).getXferName());
            const fs::path files = make(name);
            test::recompress(files, syntax);
            check(name);
            fs::remove_all(files.parent_path());
        }
}

TEST_F(DicomSeriesTest, FindsTheFragmentsOfEachFrame) {
    for (const std::size_t fragments : {1, 2, 5})
        for (const char* name : {"axial", "enhanced"}) {
            SCOPED_TRACE(std::string(name) + " in " + std::to_string(fragments) + " fragments each");
            const fs::path files = make(name);
            test::recompress(files, EXS_JPEG2000LosslessOnly, fragments);
            check(name);
            fs::remove_all(files.parent_path());
        }
}

TEST_F(DicomSeriesTest, KeepsTheValuesOfInvertedImagesAndSaysSo) {
    EXPECT_TRUE(notes_mention(read_and_check("inverted").notes, "MONOCHROME1"));
}

TEST_F(DicomSeriesTest, ReadsTheFramesOfEnhancedImagesLikeSlices) {
    for (const char* name : {"enhanced", "enhanced_files", "enhanced_rle"}) {
        SCOPED_TRACE(name);
        const DicomVolume volume = read_and_check(name);
        EXPECT_TRUE(has_samples<std::int16_t>(volume));
        EXPECT_EQ(volume.series.files.size(), 9u);
        EXPECT_EQ(volume.series.frames.size(), 9u);
        EXPECT_NE(volume.series.frames, (std::vector<std::int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9})) << "sorted by place";
    }
    EXPECT_TRUE(has_samples<float>(read_and_check("enhanced_slopes")));
}

TEST_F(DicomSeriesTest, TellsTheVolumesOfAnEnhancedImageApart) {
    const fs::path files = make("enhanced_echoes");
    const Truth truth = read_truth(folder_ / "enhanced_echoes");
    const auto series = list_dicom_series(files);
    ASSERT_EQ(series.size(), 2u);
    EXPECT_EQ(series[0].distinction, "echo time 2.5");
    EXPECT_EQ(series[1].distinction, "echo time 4.75");
    for (int volume : {1, 2}) {
        const DicomVolume read = read_dicom_series(files, {.volume = volume});
        for (std::size_t n = 0; n < truth.values.size(); ++n)
            ASSERT_EQ(sample(read.image, n), truth.values[n] + volume - 1) << "volume " << volume;
    }
}

TEST_F(DicomSeriesTest, RefusesEnhancedImagesThatMakeNoVolume) {
    EXPECT_REFUSED(refusal(make("enhanced_missing")), unsupported, "slices are missing between");
    EXPECT_REFUSED(refusal(make("enhanced_ambiguous")), unsupported, "and nothing tells them apart: enhanced0.dcm, frame ");
    EXPECT_REFUSED(refusal(make("enhanced_incomplete")), corrupt_file,
                   "frame 6: PlanePositionSequence (0020,9113) is missing");
}

TEST_F(DicomSeriesTest, LeavesOutFilesThatAreNoImagesAndSaysSo) {
    const DicomVolume volume = read_and_check("company");
    EXPECT_TRUE(notes_mention(volume.notes, "left out 2 files (not a DICOM file): README.txt, ..."));
    EXPECT_FALSE(notes_mention(volume.notes, "RTSTRUCT"));  // its place is there
    EXPECT_TRUE(notes_mention(volume.notes, "left out 1 file (image without a position in space): capture.dcm"));
}

TEST_F(DicomSeriesTest, IgnoresTagsThatSetNoVolumesApart) {
    read_and_check("acquisitions");
    EXPECT_TRUE(notes_mention(read_and_check("anonymised").notes, "frame of reference"));
}

TEST_F(DicomSeriesTest, AsksWhichOfSeveralSeries) {
    const fs::path files = make("other_series");
    EXPECT_REFUSED(refusal(files), invalid_input, "several series; choose one with the option series_uid: ");
    const auto found = list_dicom_series(files);
    ASSERT_EQ(found.size(), 2u);
    for (const DicomSeries& series : found) {
        EXPECT_REFUSED(refusal(files), invalid_input,
                       series.series_uid + " volume 1 (CT '" + series.description + "', 9 slices of 14 x 12)");
        EXPECT_EQ(read_dicom_series(files, {.series_uid = series.series_uid}).series.files, series.files);
        EXPECT_EQ(read_dicom_series(series.files[3]).series.series_uid, series.series_uid) << "a file stands for its series";
    }
    EXPECT_REFUSED(refusal(files, {.series_uid = "1.2.3"}), invalid_input, "there is no series 1.2.3; there are: ");
}

TEST_F(DicomSeriesTest, DamageInOneSeriesLeavesTheOthers) {
    const fs::path files = make("other_damaged");
    const auto series = list_dicom_series(files);
    ASSERT_EQ(series.size(), 1u);
    const DicomVolume unasked = check("other_damaged");
    EXPECT_TRUE(unasked.notes.empty());
    EXPECT_EQ(unasked.warnings,
              (std::vector<std::string>{"left out 1 damaged file of other series: " + (files / "capture.dcm").string() +
                                        ": RescaleSlope (0028,1053) is 0"}));
    EXPECT_REFUSED(refusal(files / "capture.dcm"), corrupt_file, "capture.dcm: RescaleSlope (0028,1053) is 0");
    const DicomVolume volume = check("other_damaged", {.series_uid = series[0].series_uid});
    EXPECT_EQ(volume.notes, (std::vector<std::string>{"left out 1 damaged file of other series: capture.dcm"}));
    EXPECT_TRUE(volume.warnings.empty());
    EXPECT_EQ(read_dicom_grid(series[0].files[2]).grid, volume.image.grid) << "a file stands for its series";
    const fs::path damaged = make("own_damaged");
    EXPECT_REFUSED(refusal(damaged), corrupt_file, "RescaleSlope (0028,1053) is 0");
    EXPECT_REFUSED(refusal(damaged, {.series_uid = list_dicom_series(damaged)[0].series_uid}), corrupt_file, "is 0");
}

TEST_F(DicomSeriesTest, NumbersThatOnlyOrderSlicesMayBeNone) { read_and_check("numbered"); }

TEST_F(DicomSeriesTest, RefusesMosaics) {
    EXPECT_REFUSED(refusal(make("mosaic")), unsupported,
                   "it is a Siemens mosaic, many slices in one image; convert it with dcm2niix first");
}

TEST_F(DicomSeriesTest, RefusesParametricMapsByWhatTheyAre) {
    for (const char* name : {"enhanced_float", "enhanced_double"})
        EXPECT_REFUSED(refusal(make(name)), unsupported,
                       "enhanced0.dcm: its pixels are floating-point numbers, as of a parametric map, which are not read");
}

TEST_F(DicomSeriesTest, PassesOverLinksThatLeadNowhere) {
    const fs::path files = make("axial");
    fs::create_symlink("loop", files / "loop");
    fs::create_symlink("nothing", files / "dangling");
    EXPECT_EQ(check("axial").notes, (std::vector<std::string>{"left out 1 file (Too many levels of symbolic links): loop"}));
    EXPECT_NO_THROW(file_sha256(files));
    EXPECT_REFUSED(refusal(files / "loop"), io, "loop: no such file");
}

TEST_F(DicomSeriesTest, TellsVolumesAtTheSamePositionsApart) {
    for (const char* name : {"echoes", "times"}) {
        const fs::path files = make(name);
        const Truth truth = read_truth(folder_ / name);
        EXPECT_REFUSED(refusal(files), invalid_input, "several volumes; choose one with the option volume: ");
        for (int volume : {1, 2}) {
            const DicomVolume read = read_dicom_series(files, {.volume = volume});
            for (std::size_t n = 0; n < truth.values.size(); ++n)
                ASSERT_EQ(sample(read.image, n), truth.values[n] + volume - 1) << name << " volume " << volume;
        }
        const auto series = list_dicom_series(files);
        ASSERT_EQ(series.size(), 2u);
        EXPECT_EQ(series[1].distinction, std::string(name) == "echoes" ? "echo 2" : "time 2 of 2");
        EXPECT_EQ(read_dicom_series(series[1].files[0]).series.files, series[1].files) << "a file stands for its volume";
        EXPECT_REFUSED(refusal(files, {.volume = 3}), invalid_input, "there is no volume 3");
    }
}

TEST_F(DicomSeriesTest, RefusesDuplicatesAndUnsupportedVariantsByName) {
    EXPECT_REFUSED(refusal(make("doubled")), unsupported, "two slices lie at z = 112.5 mm, and nothing tells them apart");
    EXPECT_REFUSED(refusal(make("mpeg")), unsupported, "the compression 'MPEG2 Main Profile @ Main Level' is not supported");
    EXPECT_REFUSED(refusal(make("colour")), unsupported, "'RGB'");
}

TEST_F(DicomSeriesTest, RefusesMoreVoxelsThanAllowed) {
    EXPECT_REFUSED(refusal(make("axial"), {.max_voxels = 1511}), too_large,
                   "the volume has 14 x 12 x 9 voxels; the limit is 1511 voxels");
}

TEST_F(DicomSeriesTest, RefusesDamagedAndAbsentFiles) {
    EXPECT_REFUSED(refusal(make("truncated")), corrupt_file, ".dcm: ");
    EXPECT_REFUSED(refusal(folder_ / "nowhere"), io, "nowhere: no such file or folder");
    fs::create_directory(folder_ / "bare");
    EXPECT_REFUSED(refusal(folder_ / "bare"), invalid_input, "bare: there is no DICOM image to read");
    test::write_bytes(folder_ / "bare" / "notes.txt", "x");
    EXPECT_REFUSED(refusal(folder_ / "bare"), invalid_input, "left out 1 file (not a DICOM file): notes.txt");
}

/// A folder with the first slice of a series, which is a series of its own.
class DamagedDicomTest : public DicomSeriesTest, public testing::WithParamInterface<const char*> {};

TEST_P(DamagedDicomTest, EndsInAnErrorOrAVolume) {
    const std::string kind = GetParam();
    const fs::path files = make(kind == "rle" || kind == "deflated" || kind == "implicit" || kind == "enhanced" ? kind
                                : kind == "frames_2000"                                                         ? "enhanced"
                                                                                                                : "axial");
    if (kind == "jpeg") test::recompress(files, EXS_JPEGProcess14SV1);
    if (kind == "jpeg_ls") test::recompress(files, EXS_JPEGLSLossless);
    if (kind == "jpeg_2000" || kind == "frames_2000") test::recompress(files, EXS_JPEG2000LosslessOnly);
    const std::string bytes = test::read_bytes(fs::directory_iterator(files)->path());
    const fs::path alone = folder_ / "alone";
    fs::create_directory(alone);
    int accepted = 0;
    const auto read_damaged = [&](const std::string& damaged) {
        test::write_bytes(alone / "slice.dcm", damaged);
        try {
            read_dicom_series(alone);
            ++accepted;
        } catch (const Error&) {
        }
    };
    test::for_each_prefix(bytes, 13, read_damaged);
    EXPECT_EQ(accepted, 0) << "a part of a file is no slice";
    test::for_each_mutant(bytes, 300, 5, read_damaged);
    EXPECT_GT(accepted, 0) << "changed pixels or names are still a slice";
}

INSTANTIATE_TEST_SUITE_P(Encodings, DamagedDicomTest,
                         testing::Values("axial", "implicit", "deflated", "rle", "jpeg", "jpeg_ls", "jpeg_2000", "enhanced",
                                         "frames_2000"));

}  // namespace
}  // namespace kontur
