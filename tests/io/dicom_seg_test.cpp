// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_seg.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/io/image.h"
#include "kontur/io/read_provenance.h"
#include "support/damage.h"
#include "support/expect_error.h"
#include "support/random.h"
#include "support/recompress.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

std::string run(const std::string& script, const std::vector<std::string>& arguments) {
    const auto result = test::run_python(script, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return result.output;
}

class WriteDicomSeg : public testing::Test {
protected:
    void use_images(const std::string& name) {
        run("make_dicom_series.py", {name, (folder_ / name).string()});
        images_ = folder_ / name / "dicom";
        const DicomGrid found = read_dicom_grid(images_);
        series_ = found.series;
        grid_ = found.grid;
    }

    /// Every voxel 0, 1, 2 or 3 by chance.
    Image random_labels() const {
        std::mt19937 random = test::random_of_this_test();
        std::vector<std::uint8_t> labels(static_cast<std::size_t>(grid_.voxel_count()));
        for (std::uint8_t& label : labels) label = static_cast<std::uint8_t>(random() % 4);
        return {grid_, labels};
    }

    std::string verdict(const Image& labels) const {
        const auto& values = std::get<std::vector<std::uint8_t>>(labels.samples);
        test::write_bytes(folder_ / "truth.raw", std::string(values.begin(), values.end()));
        return run("check_dicom_seg.py", {path().string(), images_.string(), (folder_ / "truth.raw").string()});
    }

    fs::path path() const { return folder_ / "seg.dcm"; }
    static std::vector<DicomSegment> three_segments() {
        return {{.number = 1, .label = "L\xC3\xA4sion \xD0\x96", .algorithm_name = "kontur", .color = {{255, 0, 0}}},
                {.number = 2, .label = "two", .algorithm_type = "AUTOMATIC", .algorithm_name = "net"},
                {.number = 3,
                 .label = "three",
                 .algorithm_name = "kontur",
                 .color = {{10, 200, 30}},
                 .description = "third\nsegment",
                 .category = {{"123037004", "SCT", "Anatomical Structure"}},
                 .code = {{"10200004", "SCT", "Liver"}}}};
    }

    test::TemporaryFolder folder_;
    fs::path images_;
    DicomSeries series_;
    Grid grid_;
};

TEST_F(WriteDicomSeg, ComesBackVoxelByVoxelHereAndElsewhere) {
    for (const char* images : {"axial", "oblique", "tilt", "odd"}) {
        SCOPED_TRACE(images);
        use_images(images);
        const Image labels = random_labels();
        write_dicom_seg(path(), {labels, three_segments()}, series_, {.algorithm = {"interpolation", "1.2", "kernel=r\\3"}});
        const Image again = read_image(path());
        EXPECT_EQ(again.samples, labels.samples);
        EXPECT_LT(corner_distance_mm(again.grid, grid_), 1e-6);
        EXPECT_LT(corner_distance_mm(read_grid(path()), grid_), 1e-6);
        EXPECT_EQ(read_mask(path(), 2).values, select_label(labels, 2).values);

        const std::string seen = verdict(labels);
        EXPECT_NE(seen.find("1 L\xC3\xA4sion \xD0\x96 SEMIAUTOMATIC kontur [35580, 53665, 50855]"), std::string::npos)
            << "red in D50 is L*a*b* 54.29, 80.81, 69.89: " << seen;
        EXPECT_NE(seen.find("algorithm: interpolation 1.2 kernel=r/3"), std::string::npos) << seen;
    }
}

TEST_F(WriteDicomSeg, HowItWasMadeComesBack) {
    use_images("axial");
    const Provenance made{{"contours_sha256", std::string(64, 'a')}, {"made_by", "kontur convert"}, {"note", "a; b"}};
    write_dicom_seg(path(), {random_labels(), three_segments()}, series_, {.provenance = made});
    EXPECT_EQ(read_provenance(path()), made);
}

TEST_F(WriteDicomSeg, NoValueOfHowItWasMadeCanPassForTwoEntries) {
    use_images("axial");
    const Provenance made{{"note", "a; word: x"}, {"ends", "b;"}, {"twice", ";; c: d;;;"}, {"empty", ""}, {"last", ";"}};
    write_dicom_seg(path(), {random_labels(), three_segments()}, series_, {.provenance = made});
    EXPECT_EQ(read_provenance(path()), made);
}

TEST_F(WriteDicomSeg, HowItWasMadeIsReadWithUndoubledSemicolonsToo) {
    use_images("axial");
    write_dicom_seg(path(), {random_labels(), three_segments()}, series_,
                    {.provenance = {{"note", "a;b"}, {"made_by", "kontur convert"}}});
    std::string bytes = test::read_bytes(path());
    const std::size_t doubled = bytes.find("a;;b");
    ASSERT_NE(doubled, std::string::npos);
    test::write_bytes(path(), bytes.replace(doubled, 4, "a; b"));
    EXPECT_EQ(read_provenance(path()), (Provenance{{"note", "a; b"}, {"made_by", "kontur convert"}}));
}

TEST_F(WriteDicomSeg, KeepsWhatIsSaidAboutSegments) {
    use_images("odd");
    write_dicom_seg(path(), {random_labels(), three_segments()}, series_);
    const DicomSegmentation found = read_dicom_segmentation(path());
    ASSERT_EQ(found.segments.size(), 3u);
    EXPECT_EQ(found.segments[0].label, "L\xC3\xA4sion \xD0\x96");
    EXPECT_EQ(found.segments[1].algorithm_type, "AUTOMATIC");
    EXPECT_EQ(found.segments[1].algorithm_name, "net");
    EXPECT_EQ(found.segments[1].color, std::nullopt);
    EXPECT_EQ(found.segments[2].color, (std::array<std::uint8_t, 3>{10, 200, 30}));
    EXPECT_EQ(found.segments[1].code, (CodedConcept{"85756007", "SCT", "Tissue"})) << "of which nothing was said";
    EXPECT_EQ(found.segments[2].category, (CodedConcept{"123037004", "SCT", "Anatomical Structure"}));
    EXPECT_EQ(found.segments[2].code, (CodedConcept{"10200004", "SCT", "Liver"}));
    EXPECT_EQ(found.segments[2].description, "third\nsegment");
    EXPECT_EQ(found.frame_of_reference_uid, series_.frame_of_reference_uid);
    EXPECT_EQ(found.referenced_series_uid, series_.series_uid);
    EXPECT_EQ(found.segments[0].voxels, count_labels(random_labels()).at(1));
}

TEST_F(WriteDicomSeg, SaysWhichNamesItChanged) {
    use_images("axial");
    std::vector<DicomSegment> segments = three_segments();
    EXPECT_TRUE(write_dicom_seg(path(), {random_labels(), segments}, series_).empty());
    segments[0].label = std::string(70, 'a');
    segments[1].label = std::string(64, 'a');
    segments[2].label = "back\\slash";
    const std::vector<std::string> notes = write_dicom_seg(path(), {random_labels(), segments}, series_);
    ASSERT_EQ(notes.size(), 3u);
    EXPECT_NE(
        notes[2].find("has backslashes or control characters, which DICOM cannot hold there; it is written as 'back/slash'"),
        std::string::npos)
        << notes[2];
    const auto again = read_dicom_segmentation(path()).segments;
    EXPECT_EQ(again[0].label, std::string(64, 'a'));
    EXPECT_EQ(again[1].label, std::string(60, 'a') + " (2)") << "or two segments would have one name";
    segments[0].label = "Leb\xe4r";
    EXPECT_KONTUR_ERROR(write_dicom_seg(path(), {random_labels(), segments}, series_), ErrorKind::invalid_input,
                        "is not UTF-8");
}

TEST_F(WriteDicomSeg, NamesANewFrameOfReferenceWhereTheImagesNameNone) {
    use_images("no_frame");
    write_dicom_seg(path(), {random_labels(), three_segments()}, series_);
    EXPECT_FALSE(read_dicom_segmentation(path()).frame_of_reference_uid.empty());
}

TEST_F(WriteDicomSeg, TakesMirroredTurnedAndCroppedMasks) {
    use_images("oblique");
    Image labels = random_labels();
    const auto values = std::get<std::vector<std::uint8_t>>(labels.samples);
    // i runs along the image's -k, j along i, k along j; the last two columns are cropped.
    Grid turned{{grid_.size.k, grid_.size.i - 2, grid_.size.j}, {}};
    turned.index_to_mm.set_column(0, -grid_.index_to_mm.column(2));
    turned.index_to_mm.set_column(1, grid_.index_to_mm.column(0));
    turned.index_to_mm.set_column(2, grid_.index_to_mm.column(1));
    turned.index_to_mm.translation = grid_.center_mm(0, 0, grid_.size.k - 1);
    std::vector<std::uint8_t> moved(static_cast<std::size_t>(turned.voxel_count()));
    std::vector<std::uint8_t> expected(values.size());
    for (std::int64_t k = 0; k < grid_.size.k; ++k)
        for (std::int64_t j = 0; j < grid_.size.j; ++j)
            for (std::int64_t i = 0; i + 2 < grid_.size.i; ++i)
                moved[turned.offset(grid_.size.k - 1 - k, i, j)] = expected[grid_.offset(i, j, k)] =
                    values[grid_.offset(i, j, k)];
    write_dicom_seg(path(), {{turned, moved}, three_segments()}, series_);
    EXPECT_EQ(read_image(path()).samples, Image::Samples(expected));
}

TEST_F(WriteDicomSeg, KeepsEveryVoxelOfOverlappingMasks) {
    use_images("odd");
    std::vector<Mask> masks;
    for (int bit = 1; bit <= 2; bit *= 2) {
        masks.push_back({grid_, std::get<std::vector<std::uint8_t>>(random_labels().samples)});
        for (std::uint8_t& value : masks.back().values) value = (value & bit) != 0;  // 3 is in both
    }
    auto segments = three_segments();
    segments.pop_back();
    write_dicom_seg_masks(path(), {masks, segments}, series_);
    const std::vector<Mask> again = read_dicom_seg_masks(path());
    ASSERT_EQ(again.size(), 2u);
    EXPECT_EQ(again[0].values, masks[0].values);
    EXPECT_EQ(again[1].values, masks[1].values);
    EXPECT_GT(read_dicom_segmentation(path()).segments[0].shared_voxels, 0);
    EXPECT_KONTUR_ERROR(write_dicom_seg_masks(path(), {masks, three_segments()}, series_), ErrorKind::invalid_input,
                        "there are 2 masks for 3 segments");
    masks[1].values.assign(masks[1].values.size(), 0);
    EXPECT_KONTUR_ERROR(write_dicom_seg_masks(path(), {masks, segments}, series_), ErrorKind::invalid_input,
                        "the segment 'two' has no voxels");
}

TEST_F(WriteDicomSeg, RefusesWhatDoesNotFit) {
    use_images("axial");
    Image labels = random_labels();
    auto segments = three_segments();
    segments.pop_back();
    EXPECT_KONTUR_ERROR(write_dicom_seg(path(), {labels, segments}, series_), ErrorKind::invalid_input,
                        "have the label 3, which no segment has");
    segments = three_segments();
    segments.push_back({.number = 7, .label = "seven"});
    EXPECT_KONTUR_ERROR(write_dicom_seg(path(), {labels, segments}, series_), ErrorKind::invalid_input,
                        "segment 7 'seven' has no voxels");
    const Vec3 first_slice = labels.grid.index_to_mm.translation;
    const auto& values = std::get<std::vector<std::uint8_t>>(labels.samples);
    const auto of_last_slice =
        std::count_if(values.end() - grid_.size.i * grid_.size.j, values.end(), [](auto v) { return v != 0; });
    labels.grid.index_to_mm.translation = grid_.center_mm(0, 0, 1);
    EXPECT_KONTUR_ERROR(write_dicom_seg(path(), {labels, three_segments()}, series_), ErrorKind::invalid_input,
                        std::to_string(of_last_slice) + " of its ");
    labels.grid.index_to_mm.translation = first_slice;
    labels.grid.index_to_mm.translation.x += 0.35;
    EXPECT_KONTUR_ERROR(write_dicom_seg(path(), {labels, three_segments()}, series_), ErrorKind::invalid_input,
                        "they are up to 0.5 of a voxel off; the limit is 0.05");
    labels.grid.index_to_mm = grid_.index_to_mm;
    labels.grid.index_to_mm.set_column(2, 0.5 * grid_.index_to_mm.column(2));
    EXPECT_KONTUR_ERROR(write_dicom_seg(path(), {labels, three_segments()}, series_), ErrorKind::invalid_input,
                        "its voxels of 0.7 x 0.8 x 1.25 mm are not those of the images, which have 0.7 x 0.8 x 2.5 mm");
    EXPECT_FALSE(fs::exists(path()));
}

class ReadDicomSeg : public testing::Test {
protected:
    fs::path make(const std::string& name) {
        run("make_dicom_seg.py", {name, path().string(), (folder_ / "truth").string()});
        return path();
    }
    std::vector<std::uint8_t> truth() const {
        const std::string bytes = test::read_bytes(folder_ / "truth");
        return {bytes.begin(), bytes.end()};
    }
    fs::path path() const { return folder_ / "seg.dcm"; }

    test::TemporaryFolder folder_;
};

TEST_F(ReadDicomSeg, PlacesFramesInAnyOrderWithSlicesLeftOut) {
    make("shuffled");
    const DicomSeg found = read_dicom_seg(path());
    EXPECT_EQ(found.labels.samples, Image::Samples(truth()));
    Grid expected{{7, 5, 6}, {}};
    expected.index_to_mm.set_column(0, {0.42, 0.56, 0});
    expected.index_to_mm.set_column(1, {0, 0, 0.5});
    expected.index_to_mm.set_column(2, {1.6, -1.2, 0});
    expected.index_to_mm.translation = {10, 20, 30};
    EXPECT_LT(corner_distance_mm(found.labels.grid, expected), 1e-6);
    EXPECT_TRUE(is_dicom_seg(path()));
}

TEST_F(ReadDicomSeg, ReadsOverlappingSegmentsOneByOne) {
    make("overlapping");
    EXPECT_KONTUR_ERROR(read_image(path()), ErrorKind::invalid_input, "'L\xC3\xA4sion' and 4 'node' overlap; choose one");
    const std::vector<std::uint8_t> first = read_mask(path(), 1).values;
    const std::vector<std::uint8_t> expected = truth();
    for (std::size_t n = 0; n < first.size(); ++n) ASSERT_EQ(first[n] != 0, expected[n] == 1) << n;
    EXPECT_KONTUR_ERROR(read_mask(path(), 2), ErrorKind::invalid_input,
                        "there is no segment 2; there are: 1 'L\xC3\xA4sion', 4 'node'");
}

TEST_F(ReadDicomSeg, GivesEachSegmentItsOwnMaskAndSaysWhichOverlap) {
    make("overlapping");
    const std::vector<std::uint8_t> labels = truth();
    const std::vector<Mask> masks = read_dicom_seg_masks(path());
    ASSERT_EQ(masks.size(), 2u);
    std::int64_t shared = 0, first = 0, second = 0;
    const std::size_t voxels = masks[0].values.size();
    ASSERT_EQ(labels.size(), 2 * voxels);
    for (std::size_t n = 0; n < voxels; ++n) {
        ASSERT_EQ(masks[0].values[n] != 0, labels[n] == 1) << n;
        ASSERT_EQ(masks[1].values[n], labels[voxels + n]) << n;
        shared += masks[0].values[n] && masks[1].values[n];
        first += masks[0].values[n];
        second += masks[1].values[n];
    }
    ASSERT_GT(shared, 0);
    const DicomSegmentation about = read_dicom_segmentation(path());
    EXPECT_EQ(about.segments[0].voxels, first);
    EXPECT_EQ(about.segments[1].voxels, second);
    for (const DicomSegment& segment : about.segments) EXPECT_EQ(segment.shared_voxels, shared);
    ASSERT_EQ(about.notes.size(), 1u);
    EXPECT_NE(about.notes[0].find(" voxels of 4 'node'"), std::string::npos) << about.notes[0];
    EXPECT_KONTUR_ERROR(read_dicom_seg_masks(path(), masks[0].grid.voxel_count()), ErrorKind::too_large, "2 masks of");
    EXPECT_TRUE(read_dicom_segmentation(make("shuffled")).notes.empty());
}

TEST_F(ReadDicomSeg, CountsFractionsFromOneHalfOn) {
    make("fractional");
    const DicomSeg found = read_dicom_seg(path());
    EXPECT_EQ(found.labels.samples, Image::Samples(truth()));
    ASSERT_EQ(found.notes.size(), 1u);
    EXPECT_NE(found.notes.front().find("one half"), std::string::npos);
}

TEST_F(ReadDicomSeg, ReadsLabelMaps) {
    for (const char* name : {"labelmap", "labelmap_padded", "labelmap_unpadded", "labelmap_palette"}) {
        SCOPED_TRACE(name);
        make(name);
        EXPECT_TRUE(is_dicom_seg(path()));
        EXPECT_EQ(read_dicom_seg(path()).labels.samples, Image::Samples(truth()));
        const DicomSegmentation about = read_dicom_segmentation(path());
        ASSERT_EQ(about.segments.size(), 2u) << "the background is none";
        const std::vector<Mask> masks = read_dicom_seg_masks(path());
        const std::vector<std::uint8_t> labels = truth();
        for (std::size_t s = 0; s < 2; ++s) {
            EXPECT_EQ(about.segments[s].voxels, std::count(labels.begin(), labels.end(), about.segments[s].number));
            EXPECT_EQ(about.segments[s].shared_voxels, 0);
            EXPECT_EQ(masks[s].values, read_mask(path(), about.segments[s].number).values);
            for (std::size_t n = 0; n < labels.size(); ++n)
                ASSERT_EQ(masks[s].values[n] != 0, labels[n] == about.segments[s].number);
        }
    }
}

TEST_F(ReadDicomSeg, ReadsLabelMapsOf16Bits) {
    make("labelmap_16");
    std::vector<std::uint16_t> expected;
    for (const std::uint8_t label : truth()) expected.push_back(label == 4 ? 300 : label);
    EXPECT_EQ(read_dicom_seg(path()).labels.samples, Image::Samples(expected));
}

TEST_F(ReadDicomSeg, ReadsWhatIsRunLengthCodedOrDeflated) {
    for (const char* name : {"labelmap_rle", "labelmap_deflated", "labelmap_frames", "fractional_rle", "fractional_deflated",
                             "fractional_frames", "shuffled_deflated", "shuffled_frames"}) {
        SCOPED_TRACE(name);
        make(name);
        EXPECT_EQ(read_dicom_seg(path()).labels.samples, Image::Samples(truth()));
    }
}

TEST_F(ReadDicomSeg, ReadsJpeg2000AndLosslessJpeg) {
    const fs::path apart = folder_ / "apart";
    fs::create_directory(apart);
    for (const char* name : {"labelmap", "labelmap_16", "fractional"})
        // Not JPEG-LS: of so small frames, DCMTK 3.6.7's encoder writes behind its buffer (valgrind).
        for (const E_TransferSyntax syntax : {EXS_JPEG2000LosslessOnly, EXS_JPEGProcess14SV1}) {
            SCOPED_TRACE(std::string(name) + " in " + DcmXfer(syntax).getXferName());
            const Image plain = read_dicom_seg(make(name)).labels;
            fs::rename(path(), apart / "seg.dcm");
            test::recompress(apart, syntax);
            EXPECT_EQ(read_dicom_seg(apart / "seg.dcm").labels.samples, plain.samples);
        }
}

TEST_F(ReadDicomSeg, NamesACompressionThatItDoesNotRead) {
    const std::string bytes = test::read_bytes(make("shuffled_frames"));
    std::string other = bytes;
    other.replace(bytes.find("1.2.840.10008.1.2.8.1"), 22, "1.2.840.10008.1.2.7.1\0", 22);
    test::write_bytes(path(), other);
    EXPECT_KONTUR_ERROR(read_dicom_seg(path()), ErrorKind::unsupported,
                        "the compression 'SMPTE ST 2110-20 Uncompressed Progressive Active Video' of its pixels");
}

TEST_F(ReadDicomSeg, SaysThatFramesLieFartherApartThanDeclared) {
    const DicomSegmentation found = read_dicom_segmentation(make("halved"));
    EXPECT_EQ(found.grid.size.k, 11);
    EXPECT_EQ(found.notes, (std::vector<std::string>{"slices are declared 1 mm apart, but no two frames lie less than 2 mm "
                                                     "apart; the slices between them stay empty"}));
}

TEST_F(ReadDicomSeg, RefusesContradictionsByName) {
    for (const char* most : {"0", "1000"})
        EXPECT_KONTUR_ERROR(read_dicom_seg(make(std::string("fractional_") + most)), ErrorKind::corrupt_file,
                            std::string("its MaximumFractionalValue is ") + most + "; 1 to 255 are possible");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("hair")), ErrorKind::unsupported, "its frames lie on no regular lattice");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("irregular")), ErrorKind::unsupported, "its frames lie on no regular lattice");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("turned")), ErrorKind::unsupported, "frame 3 is not parallel to the others");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("unlisted")), ErrorKind::corrupt_file,
                        "frame 4: it belongs to segment 9, which is not listed");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("short")), ErrorKind::corrupt_file, "its pixel data is shorter than");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("kind")), ErrorKind::unsupported, "type 'LABELMAP' with 1 bits");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("labelmap_unlisted")), ErrorKind::corrupt_file,
                        "frame 3: a pixel has the value 7, which is no segment's number");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("shuffled"), {}, 209), ErrorKind::too_large,
                        "7 x 5 x 6 voxels; the limit is 209 voxels");
    EXPECT_KONTUR_ERROR(read_dicom_seg(make("far")), ErrorKind::too_large, "its frames span 1e+19 slices of 2 mm");
}

class DamagedDicomSeg : public ReadDicomSeg, public testing::WithParamInterface<const char*> {};

TEST_P(DamagedDicomSeg, EndsCleanly) {
    const std::string bytes = test::read_bytes(make(GetParam()));
    const fs::path damaged_path = folder_ / "damaged.dcm";
    int refused = 0;
    const auto read_damaged = [&](const std::string& damaged) {
        test::write_bytes(damaged_path, damaged);
        try {
            read_dicom_seg(damaged_path);
        } catch (const Error&) {
            ++refused;
        }
    };
    test::for_each_prefix(bytes, 23, read_damaged);
    EXPECT_EQ(refused, static_cast<int>((bytes.size() + 22) / 23));
    test::for_each_mutant(bytes, 400, 7, read_damaged);
}

INSTANTIATE_TEST_SUITE_P(Kinds, DamagedDicomSeg,
                         testing::Values("shuffled", "labelmap_rle", "labelmap_16", "shuffled_frames"));

TEST(DicomSegReal, OfAnotherProgramEqualsItsLabelMap) {
    KONTUR_REQUIRE_DATA("14_dicom_seg_dcmqi/liver.dcm");
    const fs::path folder = test::data_dir() / "14_dicom_seg_dcmqi";
    const Mask liver = read_mask(folder / "liver.dcm"), truth = read_mask(folder / "liver_seg.nrrd");
    EXPECT_LT(corner_distance_mm(liver.grid, truth.grid), 1e-3);
    EXPECT_EQ(liver.values, truth.values);
    EXPECT_KONTUR_ERROR(read_image(folder / "partial_overlaps.dcm"), ErrorKind::invalid_input, "overlap; choose one");
    const DicomSegmentation about = read_dicom_segmentation(folder / "partial_overlaps.dcm");
    const std::vector<Mask> masks = read_dicom_seg_masks(folder / "partial_overlaps.dcm");
    ASSERT_EQ(about.segments.size(), 5u);
    ASSERT_EQ(masks.size(), 5u);
    for (std::size_t s = 0; s < masks.size(); ++s) {
        EXPECT_EQ(masks[s].values, read_mask(folder / "partial_overlaps.dcm", about.segments[s].number).values);
        EXPECT_EQ(std::count(masks[s].values.begin(), masks[s].values.end(), 1), about.segments[s].voxels);
    }
}

}  // namespace
}  // namespace kontur
