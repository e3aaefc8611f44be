// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/nrrd.h"

#include <zlib.h>

#include <array>

#include "image_cases.h"
#include "kontur/io/image.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;
using test::expect_error;

/// A raw file of 2 x 2 x 2 bytes, by its header lines.
class NrrdLines : public ::testing::Test {
protected:
    void set(const std::string& field, const std::string& value) { fields[field] = value; }

    std::string text() const {
        std::string all = "NRRD0004\n";
        for (const auto& [field, value] : fields) all += field + ": " + value + "\n";
        return all + "\n" + voxels;
    }

    Image read() {
        test::put_content(folder / "a.nrrd", text());
        return read_nrrd(folder / "a.nrrd", options);
    }

    void expect_refused(ErrorKind kind, const std::string& part) {
        expect_error(kind, part, [&] { read(); });
    }

    test::TemporaryFolder folder;
    std::map<std::string, std::string> fields{{"type", "uint8"},
                                              {"dimension", "3"},
                                              {"sizes", "2 2 2"},
                                              {"space", "left-posterior-superior"},
                                              {"space directions", "(1,0,0) (0,1,0) (0,0,1)"},
                                              {"space origin", "(0,0,0)"},
                                              {"encoding", "raw"}};
    std::string voxels = "12345678";
    ReadImageOptions options;
};

TEST(Nrrd, IndependentReaderReadsSegments) {
    const test::TemporaryFolder folder;
    Image labels = test::pattern_image<std::uint8_t>(test::all_orientations().back());
    for (auto& value : std::get<std::vector<std::uint8_t>>(labels.samples)) value = static_cast<std::uint8_t>(value / 100);
    const std::vector<NrrdSegment> segments{{"liver", {0.9, 0.5, 0}, 1, 0}, {"lesion \\ of \n two lines", {0, 0, 1}, 2, 0}};
    write_seg_nrrd(folder / "labels.seg.nrrd", labels, segments);
    test::write_expectation(folder / "labels.seg.nrrd", labels, 1e-9);
    test::run_image_oracle("check", folder.path());
}

TEST(Nrrd, SegmentsComeBack) {
    const test::TemporaryFolder folder;
    Image labels = test::pattern_image<std::uint8_t>(test::all_orientations()[0]);
    const std::vector<NrrdSegment> segments{{"liver := \\n", {0.9, 0.5, 0}, 10, 0, "a:b|c:\\n|"},
                                            {"two\nlines", {0, 0.25, 1}, 20, 0}};
    write_seg_nrrd(folder / "a.seg.nrrd", labels, segments);
    const auto again = read_nrrd_segments(folder / "a.seg.nrrd");
    ASSERT_EQ(again.size(), 2u);
    for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_EQ(again[n].name, segments[n].name);
        EXPECT_EQ(again[n].color, segments[n].color);
        EXPECT_EQ(again[n].label_value, segments[n].label_value);
        EXPECT_EQ(again[n].tags, segments[n].tags);
    }
    write_nrrd(folder / "plain.nrrd", labels);
    EXPECT_TRUE(read_nrrd_segments(folder / "plain.nrrd").empty());
    expect_error(ErrorKind::unsupported, "floats",
                 [&] { write_seg_nrrd(folder / "b.seg.nrrd", test::pattern_image<float>(labels.grid), segments); });
}

TEST(Nrrd, MasksThatOverlapLieOnLayers) {
    const test::TemporaryFolder folder;
    const Grid grid = test::all_orientations()[5];
    std::vector<Mask> masks(3, {grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))});
    masks[0].values[0] = masks[0].values[1] = masks[1].values[1] = masks[1].values[2] = masks[2].values[3] = 1;
    const std::vector<NrrdSegment> segments{{"one", {1, 0, 0}}, {"two", {0, 1, 0}}, {"three", {0, 0, 1}, 1, 0, "a:b|"}};
    write_seg_nrrd_masks(folder / "a.seg.nrrd", masks, segments);
    const auto again = read_nrrd_segments(folder / "a.seg.nrrd");
    ASSERT_EQ(again.size(), 3U);
    EXPECT_EQ(again[2].tags, "a:b|");
    EXPECT_EQ(again[0].layer, again[2].layer);  // they share no voxel
    for (std::size_t n = 0; n < 3; ++n) {
        EXPECT_EQ(again[n].name, segments[n].name);
        ReadImageOptions options;
        options.frame = again[n].layer + 1;
        const Image layer = read_nrrd(folder / "a.seg.nrrd", options);
        EXPECT_EQ(select_label(layer, static_cast<double>(again[n].label_value)).values, masks[n].values) << n;
        EXPECT_EQ(layer.grid.size, grid.size);
    }
    write_seg_nrrd_masks(folder / "flat.seg.nrrd", std::span(masks).subspan(1, 1), std::span(segments).first(1));
    EXPECT_EQ(select_nonzero(read_nrrd(folder / "flat.seg.nrrd")).values, masks[1].values);
    expect_error(ErrorKind::invalid_input, "there are 3 masks for 2 segments",
                 [&] { write_seg_nrrd_masks(folder / "b.seg.nrrd", masks, std::span(segments).first(2)); });
    masks[1].grid = test::all_orientations()[6];
    expect_error(ErrorKind::invalid_input, "the masks lie on different grids",
                 [&] { write_seg_nrrd_masks(folder / "b.seg.nrrd", masks, segments); });
}

TEST(Nrrd, SegmentsOfThreeAxesLieOnOneLayerThoughTheFileNamesNone) {
    const test::TemporaryFolder folder;
    const Image labels = test::pattern_image<std::uint8_t>(test::all_orientations()[5]);
    write_seg_nrrd(folder / "a.seg.nrrd", labels, std::vector<NrrdSegment>{{"one", {}, 10}, {"two", {}, 20}});
    std::string text = test::content_of(folder / "a.seg.nrrd");
    for (std::size_t at = 0; (at = text.find("_Layer:=0")) != std::string::npos;) text.replace(at, 9, "_Other:=0");
    test::put_content(folder / "b.seg.nrrd", text);
    for (const NrrdSegment& segment : read_nrrd_segments(folder / "b.seg.nrrd")) EXPECT_EQ(segment.layer, 0) << segment.name;
}

TEST(Nrrd, ALabelOfOneSegmentSaysItsLayer) {
    const std::vector<NrrdSegment> segments{{"one", {}, 1, 0}, {"two", {}, 2, 1}, {"three", {}, 3, 0}, {"again", {}, 3, 1}};
    EXPECT_EQ(segment_numbers(segments), (std::vector<std::int64_t>{1, 2, 3, 4})) << "two share a value: by their places";
    EXPECT_EQ(segment_of_number(segments, 4), &segments[3]);
    EXPECT_EQ(segment_of_number(segments, 5), nullptr);
    const std::vector<NrrdSegment> unlike{{"one", {}, 7, 0}, {"two", {}, 2, 1}};
    EXPECT_EQ(segment_numbers(unlike), (std::vector<std::int64_t>{7, 2}));
    EXPECT_EQ(segment_of_number(unlike, 2), &unlike[1]);
    EXPECT_EQ(segment_of_number(unlike, 1), nullptr);
    const test::TemporaryFolder folder;
    const Grid grid = test::all_orientations()[5];
    std::vector<Mask> masks(2, {grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()), 1)});
    masks[1].values[3] = 0;
    write_seg_nrrd_masks(folder / "a.seg.nrrd", masks, std::span(segments).first(2));
    EXPECT_EQ(read_mask(folder / "a.seg.nrrd", 2).values, masks[1].values);
    expect_error(ErrorKind::invalid_input, "choose one with the option label: 1 'one', 2 'two'",
                 [&] { read_mask(folder / "a.seg.nrrd"); });
}

TEST_F(NrrdLines, EveryTruncatedPrefixOfRawIsRefused) {
    ASSERT_NO_THROW(read());
    test::expect_prefixes_refused(folder / "a.nrrd", folder / "part.nrrd", [](const fs::path& path) { read_nrrd(path); });
}

TEST(Nrrd, MasksThatOverlapKeepLabelsThatTellThemApart) {
    const test::TemporaryFolder folder;
    const Grid grid = test::all_orientations()[5];
    std::vector<Mask> masks(2, {grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))});
    masks[0].values[0] = masks[0].values[1] = masks[1].values[1] = 1;
    const auto labels_of = [&](std::int64_t first, std::int64_t second) {
        const std::vector<NrrdSegment> segments{{"one", {1, 0, 0}, first}, {"two", {0, 1, 0}, second}};
        write_seg_nrrd_masks(folder / "a.seg.nrrd", masks, segments);
        const auto again = read_nrrd_segments(folder / "a.seg.nrrd");
        ReadImageOptions options;
        options.frame = again[1].layer + 1;
        EXPECT_EQ(select_label(read_nrrd(folder / "a.seg.nrrd", options), static_cast<double>(again[1].label_value)).values,
                  masks[1].values);
        return std::pair(again[0].label_value, again[1].label_value);
    };
    EXPECT_EQ(labels_of(26, 300), std::pair(26L, 300L));
    EXPECT_EQ(labels_of(7, 7), std::pair(1L, 2L));
    EXPECT_EQ(labels_of(0, 5), std::pair(1L, 2L));
    EXPECT_EQ(labels_of(5, 65536), std::pair(1L, 2L));
}

TEST_F(NrrdLines, LayersNeedAChoice) {
    set("dimension", "4");
    voxels = "a1b2c3d4e5f6g7h8";
    for (const bool first : {true, false}) {
        set("sizes", first ? "2 2 2 2" : "2 2 2 2");
        set("space directions", first ? "none (1,0,0) (0,1,0) (0,0,1)" : "(1,0,0) (0,1,0) (0,0,1) none");
        options.frame.reset();
        expect_refused(ErrorKind::unsupported, "2 frames; choose one with the option frame (1 to 2)");
        options.frame = 2;
        const std::string expected = first ? "12345678" : "e5f6g7h8";
        EXPECT_EQ(read().samples, Image::Samples(std::vector<std::uint8_t>(expected.begin(), expected.end())));
    }
    set("space directions", "(1,0,0) none (0,1,0) (0,0,1)");
    expect_refused(ErrorKind::unsupported, "axis 2 is not in space");
    set("space directions", "none none (0,1,0) (0,0,1)");
    expect_refused(ErrorKind::unsupported, "more than one");
}

TEST_F(NrrdLines, MissingGeometryNeedsConsent) {
    const auto expect_consent = [&](const Vec3& spacing) {
        options.allow_missing_geometry = false;
        expect_refused(ErrorKind::unsupported, "allow_missing_geometry");
        options.allow_missing_geometry = true;
        EXPECT_EQ(read().grid.spacing_mm(), spacing);
    };
    set("space", "3D-right-handed");
    expect_consent({1, 1, 1});
    set("space", "LPS");
    fields.erase("space origin");
    expect_consent({1, 1, 1});
    fields.erase("space");
    fields.erase("space directions");
    set("spacings", "2 3 4");
    expect_consent({2, 3, 4});
    fields.erase("spacings");
    expect_refused(ErrorKind::corrupt_file, "lacks the field \"spacings\"");
}

TEST_F(NrrdLines, LiesAreRefused) {
    const auto original = fields;
    const auto spoil = [&](const std::string& field, const std::string& value, ErrorKind kind, const std::string& part) {
        fields = original;
        set(field, value);
        expect_refused(kind, part);
    };
    spoil("sizes", "2 0 2", ErrorKind::corrupt_file, "0 voxels along axis 2");
    spoil("sizes", "2 2 -2", ErrorKind::corrupt_file, "-2 voxels along axis 3");
    spoil("sizes", "2 2", ErrorKind::corrupt_file, "3 integers are expected");
    spoil("sizes", "2 2 2.5", ErrorKind::corrupt_file, "3 integers are expected");
    spoil("sizes", "2 2 nan", ErrorKind::corrupt_file, "3 integers are expected");
    spoil("sizes", "2 2 99999999999999999999", ErrorKind::corrupt_file, "3 integers are expected");
    spoil("sizes", "4294967296 4294967296 4294967296", ErrorKind::corrupt_file, "at most 2^53");
    spoil("sizes", "2147483648 1 1", ErrorKind::corrupt_file, "declares 2147483648 bytes of voxels, but only 8 are there");
    spoil("sizes", "2147483648 2 1", ErrorKind::too_large, "4294967296 voxels");
    spoil("space directions", "(nan,0,0) (0,1,0) (0,0,1)", ErrorKind::corrupt_file, "not finite");
    spoil("space directions", "(1,0,0) (0,1,0) (1,1,0)", ErrorKind::corrupt_file, "linearly dependent");
    spoil("space directions", "(1,0,0) (0,1,0)", ErrorKind::corrupt_file, "2 space directions for 3 axes");
    spoil("space directions", "(1,0,0) (0,1,0) (0,0", ErrorKind::corrupt_file, "no vector");
    spoil("space directions", "(1,0,0) (0,1,0) (0,0,1,0)", ErrorKind::corrupt_file, "no vector");
    spoil("space origin", "(0,inf,0)", ErrorKind::corrupt_file, "not finite");
    spoil("space origin", "0 0 0", ErrorKind::corrupt_file, "no vector");
    spoil("type", "block", ErrorKind::unsupported, "block");
    spoil("type", "short", ErrorKind::corrupt_file, "endian");
    spoil("dimension", "2", ErrorKind::unsupported, "2 axes");
    spoil("encoding", "bzip2", ErrorKind::corrupt_file, "not compressed by bzip2");
    spoil("encoding", "hex", ErrorKind::unsupported, "raw, gzip, bzip2 and text are");
    spoil("encoding", "gzip", ErrorKind::corrupt_file, "not compressed by gzip");
    spoil("encoding", "ascii", ErrorKind::corrupt_file, "bytes of voxels");
    spoil("space units", "\"furlong\" \"mm\" \"mm\"", ErrorKind::unsupported, "furlong");
    spoil("byte skip", "100", ErrorKind::corrupt_file, "ends after");
    spoil("byte skip", "-2", ErrorKind::corrupt_file, "-2");
    spoil("line skip", "5", ErrorKind::corrupt_file, "ends before its voxels");
}

TEST_F(NrrdLines, TextThatIsNoNumberIsRefused) {
    set("encoding", "ascii");
    voxels = "1 2 3 4 5 6 7 x8";
    expect_refused(ErrorKind::corrupt_file, "\"x8\"");
    voxels = "1 2 3 4 5 6 7 256";
    expect_refused(ErrorKind::corrupt_file, "\"256\"");
    voxels = "1 2 3 4 5 6 7                      ";
    expect_refused(ErrorKind::corrupt_file, "\"\"");
}

TEST_F(NrrdLines, LabelValuesThatAreNoIntegersAreRefused) {
    const std::string magic = "NRRD0004\n", segment = "Segment0_ID:=a\nSegment0_LabelValue:=one\n";
    test::put_content(folder / "a.seg.nrrd", magic + segment + text().substr(magic.size()));
    expect_error(ErrorKind::corrupt_file, "the label value of its segment 0 is \"one\", which is no integer",
                 [&] { read_nrrd_segments(folder / "a.seg.nrrd"); });
}

TEST_F(NrrdLines, DataFilesElsewhereAreRefused) {
    for (const char* name : {"/etc/passwd", "../a.raw", "sub/a.raw", "..", "."}) {
        set("data file", name);
        expect_refused(ErrorKind::unsupported, "plain file name");
    }
    set("data file", "missing.raw");
    expect_refused(ErrorKind::io, "missing.raw");
    set("data file", "LIST");
    expect_refused(ErrorKind::unsupported, "several files");
}

TEST_F(NrrdLines, GzipBombIsRefusedBeforeAllocating) {
    set("encoding", "gzip");
    set("sizes", "1024 1024 1024");
    voxels.resize(100);
    uLongf size = 100;
    std::array<Bytef, 8> zeros{};
    z_stream stream{};
    ASSERT_EQ(::deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    stream.next_in = zeros.data();
    stream.avail_in = zeros.size();
    stream.next_out = reinterpret_cast<Bytef*>(voxels.data());
    stream.avail_out = static_cast<uInt>(size);
    ASSERT_EQ(::deflate(&stream, Z_FINISH), Z_STREAM_END);
    voxels.resize(stream.total_out);
    ::deflateEnd(&stream);
    expect_refused(ErrorKind::corrupt_file, "1073741824 bytes of voxels, more than");
    set("sizes", "2 2 3");
    expect_refused(ErrorKind::corrupt_file, "declares 12 bytes of voxels, but it ends after 8");
}

}  // namespace
}  // namespace kontur
