// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/image.h"

#include <algorithm>

#include "image_cases.h"
#include "kontur/io/images/image_files.h"
#include "kontur/io/images/nrrd.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using Labels = std::map<std::int64_t, std::int64_t>;

Mask chessboard(const Grid& grid) {
    Mask mask{grid, {}};
    for (std::int64_t n = 0; n < grid.voxel_count(); ++n) mask.values.push_back(static_cast<std::uint8_t>(n % 2));
    return mask;
}

class ImageFiles : public ::testing::TestWithParam<const char*> {
protected:
    fs::path path() const { return folder / ("mask" + std::string(GetParam())); }

    test::TemporaryFolder folder;
    Mask mask = chessboard(test::all_orientations()[49]);
};

TEST_P(ImageFiles, MaskComesBack) {
    write_mask(path(), mask);
    const Mask again = read_mask(path());
    EXPECT_EQ(again.values, mask.values);
    EXPECT_LT(corner_distance_mm(again.grid, mask.grid), 5e-4);
    EXPECT_EQ(read_grid(path()), again.grid);
}

TEST_P(ImageFiles, LabelValueChoosesTheNarrowestSamples) {
    for (const std::int64_t value : {1, 7, 255, 256, 65535}) {
        write_mask(path(), mask, {.label = value});
        const Image image = read_image(path());
        EXPECT_EQ(std::holds_alternative<std::vector<std::uint8_t>>(image.samples), value <= 255);
        EXPECT_EQ(count_labels(image), (Labels{{value, 12}}));
        EXPECT_EQ(read_mask(path(), value).values, mask.values);
    }
}

TEST_P(ImageFiles, EveryVoxelInsideGetsTheLabel) {
    Mask loud = mask;
    std::replace(loud.values.begin(), loud.values.end(), std::uint8_t{1}, std::uint8_t{255});
    write_mask(path(), loud);
    EXPECT_EQ(count_labels(read_image(path())), count_labels({mask.grid, mask.values}));
}

TEST_P(ImageFiles, ImageComesBack) {
    const Image image = test::pattern_image<std::uint16_t>(mask.grid);
    write_image(path(), image);
    test::expect_same_values(read_image(path()), image, path().string());
}

TEST_P(ImageFiles, FailureLeavesNothing) {
    fs::create_directory(folder / "file");
    for (const std::int64_t value : {0, -1, 65536}) {
        expect_error(ErrorKind::invalid_input, "label value " + std::to_string(value),
                     [&] { write_mask(path(), mask, {.label = value}); });
    }
    Mask empty;
    EXPECT_THROW(write_mask(path(), empty), Error);
    EXPECT_EQ(folder.entry_count(), 1);
}

INSTANTIATE_TEST_SUITE_P(Formats, ImageFiles,
                         ::testing::Values(".nii", ".nii.gz", ".nrrd", ".seg.nrrd", ".mha", ".mgh", ".mgz", ".mgh.gz"));

TEST(ImageFileNames, AHeaderStandsForItsVoxelsToo) {
    const test::TemporaryFolder folder;
    const auto names = [&](const char* name) {
        std::vector<std::string> found;
        for (const fs::path& file : image_files(folder / name)) found.push_back(file.filename().string());
        return found;
    };
    using Names = std::vector<std::string>;
    for (const char* name : {"a.img", "a.hdr", "b.hdr", "b.img.gz", "C.IMG", "C.HDR", "v.raw", "one.nii"})
        test::put_content(folder / name, "x");
    test::put_content(folder / "d.mhd", "ObjectType = Image\nElementDataFile = v.raw\n");
    test::put_content(folder / "d.mha", "ObjectType = Image\nElementDataFile = LOCAL\nxx");
    test::put_content(folder / "d.nhdr", "NRRD0004\ndata file: ./v.raw\n\n");
    test::put_content(folder / "missing.nhdr", "NRRD0004\ndata file: none.raw\n\n");
    EXPECT_EQ(names("a.img"), (Names{"a.hdr", "a.img"}));
    EXPECT_EQ(names("a.hdr"), (Names{"a.hdr", "a.img"}));
    EXPECT_EQ(names("b.hdr"), (Names{"b.hdr", "b.img.gz"}));
    EXPECT_EQ(names("b.img.gz"), (Names{"b.hdr", "b.img.gz"}));
    EXPECT_EQ(names("C.IMG"), (Names{"C.HDR", "C.IMG"}));
    EXPECT_EQ(names("d.mhd"), (Names{"d.mhd", "v.raw"}));
    EXPECT_EQ(names("d.mha"), (Names{"d.mha"}));
    EXPECT_EQ(names("d.nhdr"), (Names{"d.nhdr", "v.raw"}));
    EXPECT_EQ(names("missing.nhdr"), (Names{"missing.nhdr"}));
    EXPECT_EQ(names("one.nii"), (Names{"one.nii"}));
}

TEST(ReadMask, AsksWhichOfSeveralLabels) {
    const test::TemporaryFolder folder;
    const Grid grid = test::all_orientations()[0];
    std::vector<std::int16_t> values(24, 0);
    values[3] = 5;
    values[7] = values[8] = 9;
    write_image(folder / "labels.nii", {grid, values});
    expect_error(ErrorKind::invalid_input, "2 labels; choose one of 5, 9", [&] { read_mask(folder / "labels.nii"); });
    expect_error(ErrorKind::invalid_input, "no label 6; its labels are 5, 9", [&] { read_mask(folder / "labels.nii", 6); });
    EXPECT_EQ(select_nonzero({grid, read_mask(folder / "labels.nii", 9).values}).values[7], 1);
}

TEST(ReadMask, RefusesFractions) {
    const test::TemporaryFolder folder;
    write_image(folder / "image.nii", test::pattern_image<float>(test::all_orientations()[0]));
    expect_error(ErrorKind::invalid_input, "no label map", [&] { read_mask(folder / "image.nii"); });
}

TEST(ReadImage, NamesTheKnownFormats) {
    const test::TemporaryFolder folder;
    test::put_content(folder / "picture.xyz", "something else");
    expect_error(ErrorKind::unsupported, ".nii", [&] { read_image(folder / "picture.xyz"); });
    expect_error(ErrorKind::unsupported, ".nii", [&] { write_mask(folder / "mask.xyz", chessboard({{4, 3, 2}, {}})); });
    expect_error(ErrorKind::unsupported, ".mha", [&] { check_image_name(folder / "mask.mhd"); });
    EXPECT_NO_THROW(check_image_name(folder / "mask.SEG.NRRD"));
    expect_error(ErrorKind::io, "No such file", [&] { read_image(folder / "missing.nii"); });
    EXPECT_EQ(folder.entry_count(), 1);
}

TEST_P(ImageFiles, FlippedBitsNeverDoMoreThanThrow) {
    write_mask(path(), mask);
    const fs::path spoiled = folder / ("spoiled" + std::string(GetParam()));
    test::expect_flips_survived(path(), spoiled, [](const fs::path& file) { read_mask(file); });
}

TEST_P(ImageFiles, ContentTellsWhatANamelessFileIs) {
    if (std::string_view(GetParam()).starts_with(".mg")) return;  // begins with nothing but a 1
    write_mask(path(), mask);
    fs::rename(path(), folder / "nameless");
    EXPECT_EQ(read_mask(folder / "nameless").values, mask.values);
}

TEST(WriteImage, SegmentationHasOneSegmentForEachLabel) {
    const test::TemporaryFolder folder;
    std::vector<std::int16_t> values(24, 0);
    values[3] = 5;
    values[7] = values[8] = 9;
    write_image(folder / "a.seg.nrrd", {test::all_orientations()[0], values});
    const auto segments = read_nrrd_segments(folder / "a.seg.nrrd");
    ASSERT_EQ(segments.size(), 2u);
    EXPECT_EQ(segments[0].label_value, 5);
    EXPECT_EQ(segments[1].label_value, 9);
    EXPECT_NE(segments[0].color, segments[1].color);
}

/// What is known of a real file by other readers.
struct RealFile {
    const char* path;
    Index3 size;
    Vec3 spacing_mm;
    double determinant_sign;
    Labels labels;
};

void PrintTo(const RealFile& file, std::ostream* out) { *out << file.path; }

class RealLabelMaps : public ::testing::TestWithParam<RealFile> {};

TEST_P(RealLabelMaps, HaveTheKnownGeometryAndCounts) {
    const RealFile& known = GetParam();
    KONTUR_REQUIRE_DATA(known.path);
    const Image image = read_image(test::data_dir() / known.path);
    EXPECT_EQ(image.grid.size, known.size);
    EXPECT_LT(norm(image.grid.spacing_mm() - known.spacing_mm), 2e-4);
    EXPECT_GT(image.grid.index_to_mm.determinant() * known.determinant_sign, 0);
    const Labels counts = count_labels(image);
    for (const auto& [label, count] : known.labels) EXPECT_EQ(counts.contains(label) ? counts.at(label) : 0, count) << label;
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealLabelMaps,
    ::testing::Values(
        RealFile{"01_ct_abdomen_totalseg_3mm/example_seg.nii.gz",
                 {122, 101, 30},
                 {3, 3, 3},
                 1,
                 {{1, 9452}, {2, 3947}, {5, 38634}}},
        RealFile{"02_ct_abdomen_torsoLabel_5mm/torsoLabel.nii.gz",
                 {384, 320, 89},
                 {0.782, 0.782, 5},
                 1,
                 {{1, 33634}, {6, 385168}}},
        RealFile{"03_sarcoma_STS_002/PET/PET_mask.nii.gz", {30, 27, 48}, {5.46875, 5.46875, 3.27}, 1, {{1, 555}}},
        RealFile{"04_sarcoma_STS_040/CT/CT_mask.nii.gz", {194, 204, 66}, {0.9766, 0.9766, 3.27}, 1, {{1, 128260}}},
        RealFile{"06_mr_brain_MRIcrop/MRIcrop-seg.nii.gz", {78, 110, 64}, {1, 1, 1}, 1, {{1, 18138}, {4, 2250}, {7, 7661}}},
        RealFile{"07_mr_brain_tumour_brain1/brain1_label.nrrd", {256, 256, 25}, {0.78125, 0.78125, 6.5}, -1, {{1, 4137}}},
        RealFile{"07_mr_brain_tumour_brain1/lung1_label.nrrd", {512, 512, 48}, {0.5703, 0.5703, 5}, 1, {{1, 837}}},
        RealFile{
            "08_spine_vertebral_bodies/vb-seg.mha", {640, 633, 299}, {0.34375, 0.34375, 1}, 1, {{1, 107980}, {7, 183404}}},
        RealFile{"10_cine_mr_SC-HF-I-1/mask_ED_endo.nii.gz", {130, 130, 12}, {1.3672, 1.3672, 10}, -1, {{1, 10473}}},
        RealFile{"12_ct_head_gantry_tilt_shear/shear_insert_threshold_mask.nii.gz",
                 {306, 422, 54},
                 {0.4824, 0.4824, 2.3708},
                 1,
                 {{1, 216417}}}));

/// Angle between the second and the third axis, less 90 degrees.
double shear_degrees(const Grid& grid) {
    const Vec3 j = normalized(grid.index_to_mm.column(1)), k = normalized(grid.index_to_mm.column(2));
    return std::abs(std::asin(dot(j, k))) * 180 / 3.14159265358979;
}

TEST(RealImages, DicomFolderAndItsFilesAreOneImage) {
    const char* file = "03_sarcoma_STS_002/CT";
    KONTUR_REQUIRE_DATA(file);
    const fs::path folder = test::data_dir() / file / "image";
    const Image image = read_image(folder);
    EXPECT_EQ(image.grid.size, (Index3{161, 143, 48}));
    EXPECT_EQ(read_grid(folder), image.grid);
    const fs::path slice = fs::directory_iterator(folder)->path();
    EXPECT_EQ(read_image(slice).samples, image.samples);
    EXPECT_LT(corner_distance_mm(read_grid(test::data_dir() / file / "CT_mask.nii.gz"), image.grid), 0.01);
}

TEST(RealImages, GantryTiltKeepsItsShearOnceChosen) {
    const char* file = "12_ct_head_gantry_tilt_shear/shear.nii.gz";
    KONTUR_REQUIRE_DATA(file);
    const fs::path path = test::data_dir() / file;
    expect_error(ErrorKind::unsupported, "option prefer", [&] { read_image(path); });
    ReadImageOptions options;
    options.prefer = NiftiTransform::sform;
    const Image image = read_image(path, options);
    EXPECT_NEAR(shear_degrees(image.grid), 18.5, 0.1);
    double low = 1e9, high = -1e9;
    for (std::size_t n = 0; n < static_cast<std::size_t>(image.grid.voxel_count()); ++n) {
        low = std::min(low, sample(image, n));
        high = std::max(high, sample(image, n));
    }
    EXPECT_NEAR(low, -1024, 0.01);
    EXPECT_NEAR(high, 789, 1);
    const Mask mask = read_mask(test::data_dir() / "12_ct_head_gantry_tilt_shear/shear_insert_threshold_mask.nii.gz");
    EXPECT_LT(corner_distance_mm(mask.grid, image.grid), 1e-3);
}

TEST(RealImages, ObliqueCineNeedsAFrame) {
    const char* file = "10_cine_mr_SC-HF-I-1/cine4d_crop.nii.gz";
    KONTUR_REQUIRE_DATA(file);
    const fs::path path = test::data_dir() / file;
    expect_error(ErrorKind::unsupported, "20 frames", [&] { read_image(path); });
    const Grid grid = read_grid(path);
    EXPECT_LT(distance(normalized(grid.index_to_mm.column(0)), {-0.105, 0.346, -0.932}), 1e-3);
    EXPECT_LT(distance(normalized(grid.index_to_mm.column(2)), {0.672, -0.666, -0.323}), 1e-3);
}

TEST(RealImages, FractionalLabelsAreNamed) {
    const char* file = "11_4d_echo_itksnap/seg4d_11f.nii.gz";
    KONTUR_REQUIRE_DATA(file);
    std::int64_t refused = 0;
    for (std::int64_t frame = 1; frame <= 11; ++frame) {
        ReadImageOptions options;
        options.frame = frame;
        try {
            read_mask(test::data_dir() / file, 1, options);
        } catch (const Error& error) {
            refused += std::string(error.what()).find("not integers") != std::string::npos;
        }
    }
    EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace kontur
