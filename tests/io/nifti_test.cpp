// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/nifti.h"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <limits>

#include "image_cases.h"
#include "kontur/io/image.h"
#include "kontur/io/image_frames.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;
using test::expect_error;

template <typename Value>
void put(std::string& bytes, std::size_t offset, Value value) {
    std::memcpy(bytes.data() + offset, &value, sizeof(value));
}

/// A valid uncompressed NIfTI-1 file as bytes, to be spoiled.
std::string valid_file(const fs::path& scratch) {
    write_nifti(scratch, test::pattern_image<std::int16_t>(test::all_orientations()[0]));
    return test::content_of(scratch);
}

class Spoiled : public ::testing::Test {
protected:
    void expect_refused(ErrorKind kind, const std::string& part) {
        test::put_content(folder / "spoiled.nii", bytes);
        expect_error(kind, part, [&] { read_nifti(folder / "spoiled.nii", options); });
    }

    test::TemporaryFolder folder;
    std::string bytes = valid_file(folder / "valid.nii");
    ReadImageOptions options;
};

TEST(Nifti, NibabelReadsMoreVoxelsInARowThanAShortHolds) {
    const test::TemporaryFolder folder;
    Grid grid = test::all_orientations().back();
    grid.size = {40000, 1, 1};
    Image image = test::pattern_image<std::uint8_t>(grid);
    write_nifti(folder / "a.nii", image);
    image.grid = read_nifti_grid(folder / "a.nii");
    test::write_expectation(folder / "a.nii", image, 1e-6);
    test::run_image_oracle("check", folder.path());
}

TEST(Nifti, ReadsPairsByEitherName) {
    const test::TemporaryFolder folder;
    test::run_image_oracle("make-pairs", folder.path());
    EXPECT_EQ(test::compare_with_expectations(
                  folder.path(), [](const fs::path& path) { return read_image(path); },
                  [](const fs::path& path) { return read_grid(path); }),
              25);
    for (const char* name : {"a.hdr", "a.img"})
        expect_error(ErrorKind::unsupported, "Analyze 7.5", [&] { read_image(folder / "analyze" / name); });
}

TEST(Nifti, RefusesEveryTruncatedPrefixOfEitherFileOfAPair) {
    const test::TemporaryFolder folder;
    test::run_image_oracle("make-pairs", folder.path());
    const auto read_pair = [&](const fs::path&) { read_nifti(folder / "part.hdr"); };
    fs::copy_file(folder / "axial_1.img", folder / "part.img");
    test::expect_prefixes_refused(folder / "axial_1.hdr", folder / "part.hdr",
                                  [&](const fs::path& path) { read_nifti(path); });
    fs::copy_file(folder / "axial_1.hdr", folder / "part.hdr", fs::copy_options::overwrite_existing);
    test::expect_prefixes_refused(folder / "axial_1.img", folder / "part.img", read_pair);
    test::expect_flips_survived(folder / "axial_2.hdr", folder / "axial_2.HDR",
                                [](const fs::path& path) { read_nifti(path); });
}

TEST(Nifti, APairWithoutItsOtherFileIsNamed) {
    const test::TemporaryFolder folder;
    test::run_image_oracle("make-pairs", folder.path());
    fs::remove(folder / "axial_1.img");
    fs::remove(folder / "axial_2.hdr");
    expect_error(ErrorKind::io, "axial_1.img", [&] { read_nifti(folder / "axial_1.hdr"); });
    expect_error(ErrorKind::io, "axial_2.hdr", [&] { read_nifti(folder / "axial_2.img"); });
    write_nifti(folder / "one.nii", test::pattern_image<std::uint8_t>(test::all_orientations()[0]));
    fs::rename(folder / "one.nii", folder / "one.hdr");
    expect_error(ErrorKind::corrupt_file, "the same file", [&] { read_nifti(folder / "one.hdr"); });
}

TEST(Nifti, WritesNoQformForShear) {
    const test::TemporaryFolder folder;
    write_nifti(folder / "sheared.nii", test::pattern_image<std::uint8_t>(test::all_orientations().back()));
    write_nifti(folder / "plain.nii", test::pattern_image<std::uint8_t>(test::all_orientations().front()));
    const auto code = [&](const char* name, std::size_t offset) { return test::content_of(folder / name)[offset]; };
    EXPECT_EQ(code("sheared.nii", 252), 0);
    EXPECT_EQ(code("sheared.nii", 254), 1);
    EXPECT_EQ(code("plain.nii", 252), 1);
    EXPECT_EQ(code("plain.nii", 254), 1);
}

TEST(Nifti, SameImageSameBytes) {
    const test::TemporaryFolder folder;
    const Image image = test::pattern_image<float>(test::all_orientations()[50]);
    write_nifti(folder / "a.nii.gz", image);
    write_nifti(folder / "b.nii.gz", image);
    EXPECT_EQ(test::content_of(folder / "a.nii.gz"), test::content_of(folder / "b.nii.gz"));
    EXPECT_EQ(test::content_of(folder / "a.nii.gz").substr(4, 4), std::string(4, '\0'));
}

TEST(Nifti, ReadsSeveralGzipMembers) {
    const test::TemporaryFolder folder;
    const std::string bytes = valid_file(folder / "valid.nii");
    for (std::size_t begin = 0; begin < bytes.size(); begin += 100) {
        const gzFile file = ::gzopen((folder / "members.nii.gz").c_str(), begin ? "ab" : "wb");
        const std::string part = bytes.substr(begin, 100);
        ::gzwrite(file, part.data(), static_cast<unsigned>(part.size()));
        ::gzclose(file);
    }
    EXPECT_EQ(read_nifti(folder / "members.nii.gz").samples, read_nifti(folder / "valid.nii").samples);
}

/// A gzip member of this many bytes: a file name pads it.
std::string gzip_member(const std::string& content, std::size_t size) {
    const auto with_name = [&](std::string name) {
        z_stream stream{};
        ::deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
        gz_header header{};
        header.name = reinterpret_cast<Bytef*>(name.data());
        ::deflateSetHeader(&stream, &header);
        std::string input = content, member(size + content.size() + 1000, '\0');
        stream.next_in = reinterpret_cast<Bytef*>(input.data());
        stream.avail_in = static_cast<uInt>(input.size());
        stream.next_out = reinterpret_cast<Bytef*>(member.data());
        stream.avail_out = static_cast<uInt>(member.size());
        EXPECT_EQ(::deflate(&stream, Z_FINISH), Z_STREAM_END);
        member.resize(stream.total_out);
        ::deflateEnd(&stream);
        return member;
    };
    return with_name(std::string(size - with_name("").size(), 'x'));
}

TEST(Nifti, GzipMembersMayEndAnywhereInTheReadersBuffer) {
    constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
    const test::TemporaryFolder folder;
    const std::string bytes = valid_file(folder / "valid.nii");
    for (const std::size_t end : {kBufferBytes - 2, kBufferBytes - 1, kBufferBytes, kBufferBytes + 1}) {
        test::put_content(folder / "members.nii.gz",
                          gzip_member(bytes.substr(0, 360), end) + gzip_member(bytes.substr(360), 1000));
        EXPECT_EQ(read_nifti(folder / "members.nii.gz").samples, read_nifti(folder / "valid.nii").samples) << end;
    }
}

TEST(Nifti, CompressesAlsoForAnExtensionInCapitals) {
    const test::TemporaryFolder folder;
    const Image image = test::pattern_image<std::int16_t>(test::all_orientations()[0]);
    write_nifti(folder / "a.nii.gz", image);
    write_nifti(folder / "A.NII.GZ", image);
    EXPECT_EQ(test::content_of(folder / "A.NII.GZ"), test::content_of(folder / "a.nii.gz"));
}

TEST(Nifti, RefusesAGzipBombBeforeAllocating) {
    const test::TemporaryFolder folder;
    std::string bytes = valid_file(folder / "valid.nii");
    put<std::int16_t>(bytes, 42, 1024);
    put<std::int16_t>(bytes, 44, 1024);
    put<std::int16_t>(bytes, 46, 1024);
    const gzFile file = ::gzopen((folder / "bomb.nii.gz").c_str(), "wb");
    ::gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
    ::gzclose(file);
    expect_error(ErrorKind::corrupt_file, "2147483648 bytes of voxels", [&] { read_nifti(folder / "bomb.nii.gz"); });
}

TEST(Nifti, RefusesEndlessBytesBehindTheVoxels) {
    const test::TemporaryFolder folder;
    const std::string bytes = valid_file(folder / "valid.nii") + std::string(4 << 20, '\0');
    const gzFile file = ::gzopen((folder / "long.nii.gz").c_str(), "wb");
    ::gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
    ::gzclose(file);
    expect_error(ErrorKind::corrupt_file, "follow its last voxel", [&] { read_nifti(folder / "long.nii.gz"); });
}

TEST_F(Spoiled, ImpossibleSizesAreRefused) {
    for (const auto axes : std::initializer_list<std::int16_t>{0, -1, 8, 32767}) {
        put<std::int16_t>(bytes, 40, axes);
        expect_refused(ErrorKind::corrupt_file, std::to_string(axes) + " axes");
    }
    put<std::int16_t>(bytes, 40, 3);
    for (const auto size : std::initializer_list<std::int16_t>{0, -1, -32768}) {
        put<std::int16_t>(bytes, 44, size);
        expect_refused(ErrorKind::corrupt_file, std::to_string(size) + " voxels along axis 2");
    }
    put<std::int16_t>(bytes, 44, 30000);
    put<std::int16_t>(bytes, 46, 30000);
    expect_refused(ErrorKind::too_large, "3600000000 voxels");
    options.max_voxels = std::numeric_limits<std::int64_t>::max();
    expect_refused(ErrorKind::corrupt_file, "declares 7200000000 bytes of voxels, but only 48 are there");
}

TEST_F(Spoiled, VoxelCountsBeyond64BitsAreRefused) {
    Grid grid = test::all_orientations()[0];
    grid.size = {40000, 1, 1};
    write_nifti(folder / "version2.nii", test::pattern_image<std::uint8_t>(grid));
    bytes = test::content_of(folder / "version2.nii");
    for (const std::int64_t size :
         {std::int64_t{1} << 31, std::int64_t{1} << 62, std::numeric_limits<std::int64_t>::max()}) {
        for (std::size_t axis = 1; axis <= 3; ++axis) put<std::int64_t>(bytes, 16 + 8 * axis, size);
        expect_refused(ErrorKind::corrupt_file, "at most 2^53");
    }
    for (std::size_t axis = 1; axis <= 3; ++axis) put<std::int64_t>(bytes, 16 + 8 * axis, 2);
    put<std::int64_t>(bytes, 16, 4);
    put<std::int64_t>(bytes, 16 + 8 * 4, std::numeric_limits<std::int64_t>::max());
    options.frame = 1;
    expect_refused(ErrorKind::corrupt_file, "frames");
}

TEST_F(Spoiled, NonFiniteGeometryIsRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const std::string valid = bytes;
    for (const float value : {nan, infinity})
        for (const std::size_t offset : {76 + 4, 256, 268, 280, 292, 296, 308, 324}) {
            bytes = valid;
            put<float>(bytes, offset, value);
            expect_refused(ErrorKind::corrupt_file, "not finite or linearly dependent");
        }
}

TEST_F(Spoiled, OtherLiesAreRefused) {
    const std::string valid = bytes;
    const auto spoil = [&](std::size_t offset, auto value, ErrorKind kind, const std::string& part) {
        bytes = valid;
        put(bytes, offset, value);
        expect_refused(kind, part);
    };
    spoil(0, std::int32_t{347}, ErrorKind::corrupt_file, "no NIfTI file");
    spoil(344, std::int32_t{0}, ErrorKind::corrupt_file, "magic");
    spoil(345, 'i', ErrorKind::corrupt_file, "second file");
    spoil(70, std::int16_t{77}, ErrorKind::corrupt_file, "datatype 77");
    spoil(70, std::int16_t{32}, ErrorKind::unsupported, "complex");
    spoil(70, std::int16_t{128}, ErrorKind::unsupported, "colours");
    spoil(108, 0.0f, ErrorKind::corrupt_file, "within its header");
    spoil(108, -1e30f, ErrorKind::corrupt_file, "within its header");
    spoil(108, 1e30f, ErrorKind::corrupt_file, "within its header");
    spoil(108, 100000.0f, ErrorKind::corrupt_file, "ends after");
    spoil(108, std::numeric_limits<float>::quiet_NaN(), ErrorKind::corrupt_file, "within its header");
    spoil(112, std::numeric_limits<float>::infinity(), ErrorKind::corrupt_file, "scl_slope");
    spoil(123, '\7', ErrorKind::corrupt_file, "unit of length 7");
}

TEST_F(Spoiled, ContradictingTransformsNeedAChoice) {
    put<float>(bytes, 268, 200.0f);  // the qform's offset; the sform says 123.4
    expect_refused(ErrorKind::unsupported, "differ by 76.");
    options.prefer = NiftiTransform::sform;
    EXPECT_NEAR(read_nifti(folder / "spoiled.nii", options).grid.index_to_mm.translation.x, -123.4, 1e-4);
    options.prefer = NiftiTransform::qform;
    EXPECT_NEAR(read_nifti(folder / "spoiled.nii", options).grid.index_to_mm.translation.x, -200, 1e-4);
    put<float>(bytes, 268, 123.45f);
    test::put_content(folder / "close.nii", bytes);
    EXPECT_NO_THROW(read_nifti(folder / "close.nii"));
}

TEST_F(Spoiled, OneTransformThatIsNoneLeavesTheOther) {
    const std::string valid = bytes;
    put<float>(bytes, 76 + 12, 0);  // pixdim, which only the qform uses
    expect_refused(ErrorKind::corrupt_file,
                   "linearly dependent by its qform (pixdim 0.7 1.3 0); the option prefer sform reads it");
    options.prefer = NiftiTransform::qform;
    expect_refused(ErrorKind::corrupt_file, "linearly dependent");
    options.prefer = NiftiTransform::sform;
    EXPECT_EQ(read_nifti(folder / "spoiled.nii", options).grid, read_nifti(folder / "valid.nii").grid);
    bytes = valid;
    for (std::size_t n = 0; n < 4; ++n) put<float>(bytes, 280 + 4 * n, 0);
    expect_refused(ErrorKind::corrupt_file, "linearly dependent");
    options.prefer.reset();
    expect_refused(ErrorKind::corrupt_file, "linearly dependent by its sform; the option prefer qform reads it");
    options.prefer = NiftiTransform::qform;
    EXPECT_NO_THROW(read_nifti(folder / "spoiled.nii", options));
}

TEST_F(Spoiled, MissingTransformsNeedConsent) {
    put<std::int16_t>(bytes, 252, 0);
    put<std::int16_t>(bytes, 254, 0);
    expect_refused(ErrorKind::unsupported, "allow_missing_geometry");
    options.allow_missing_geometry = true;
    const Grid grid = read_nifti(folder / "spoiled.nii", options).grid;
    EXPECT_EQ(grid.index_to_mm.translation, Vec3{});
    EXPECT_LT(distance(grid.index_to_mm.column(0), {-0.7, 0, 0}), 1e-6);
    EXPECT_LT(distance(grid.index_to_mm.column(2), {0, 0, 2.5}), 1e-6);
}

TEST(Nifti, MasksOfSeveralFramesComeBackEachWithTheTimeBetweenThem) {
    const test::TemporaryFolder folder;
    std::vector<Mask> masks;
    for (std::size_t n = 0; n < 3; ++n) {
        Mask& mask = masks.emplace_back(Mask{test::all_orientations()[5], {}});
        mask.values.assign(static_cast<std::size_t>(mask.grid.voxel_count()), 0);
        mask.values[n] = 1;
    }
    write_masks(folder / "a.nii.gz", masks, 0.041, 7);
    const ImageFrames frames = read_image_frames(folder / "a.nii.gz");
    EXPECT_EQ(frames.count, 3);
    EXPECT_NEAR(frames.step_s.value_or(0), 0.041, 1e-8);
    for (std::int64_t n = 0; n < 3; ++n) {
        ReadImageOptions of_frame;
        of_frame.frame = n + 1;
        const Mask again = read_mask(folder / "a.nii.gz", 7, of_frame);
        EXPECT_EQ(again.values, masks[static_cast<std::size_t>(n)].values);
        EXPECT_LT(corner_distance_mm(again.grid, masks[0].grid), 1e-4);
    }
    write_masks(folder / "b.nii", std::span(masks).first(1));
    EXPECT_EQ(read_image_frames(folder / "b.nii").count, 1);
    EXPECT_FALSE(read_image_frames(folder / "b.nii").step_s.has_value());
    masks[1].grid.index_to_mm.translation.x += 1;
    expect_error(ErrorKind::invalid_input, "the mask of frame 2 has another grid",
                 [&] { write_masks(folder / "c.nii", masks); });
    expect_error(ErrorKind::unsupported, "are written as .nii or .nii.gz", [&] { write_masks(folder / "c.nrrd", masks); });
}

TEST(Nifti, LabelMapsOfSeveralFramesComeBackEachWithTheNamesOfTheirLabels) {
    const test::TemporaryFolder folder;
    const fs::path path = folder.path() / "labels.nii.gz";
    const Grid grid{{2, 1, 1}, {}};
    const std::vector<Image> frames{{grid, std::vector<std::uint8_t>{1, 0}}, {grid, std::vector<std::uint8_t>{2, 1}}};
    write_label_maps(path, frames, 0.05, {{1, "core", {}}, {2, "ball", {}}, {3, "not there", {}}});
    ASSERT_EQ(read_image_frames(path).count, 2);
    EXPECT_NEAR(read_image_frames(path).step_s.value_or(0), 0.05, 1e-8);
    for (std::int64_t n = 0; n < 2; ++n) {
        ReadImageOptions of_frame;
        of_frame.frame = n + 1;
        EXPECT_EQ(read_image(path, of_frame).samples, frames[static_cast<std::size_t>(n)].samples);
    }
    const std::vector<Image> mixed{frames[0], {grid, std::vector<std::uint16_t>{2, 1}}};
    expect_error(ErrorKind::invalid_input, "frame 2 has another grid or type", [&] { write_label_maps(path, mixed); });
    expect_error(ErrorKind::invalid_input, "there is no label map to write", [&] { write_label_maps(path, {}); });
    expect_error(ErrorKind::unsupported, ".nii.gz", [&] { write_label_maps(folder / "labels.nrrd", frames); });
}

TEST(Nifti, ReadsTheChosenFrame) {
    KONTUR_REQUIRE_DATA("11_4d_echo_itksnap/seg4d_11f_label1.nii.gz");
    const fs::path path = test::data_dir() / "11_4d_echo_itksnap/seg4d_11f_label1.nii.gz";
    expect_error(ErrorKind::unsupported, "11 frames; choose one with the option frame (1 to 11)", [&] { read_nifti(path); });
    ReadImageOptions options;
    for (const std::int64_t frame : {0, 12}) {
        options.frame = frame;
        expect_error(ErrorKind::invalid_input, "it has frames 1 to 11", [&] { read_nifti(path, options); });
    }
    options.frame = 1;
    EXPECT_EQ(count_labels(read_nifti(path, options)), (std::map<std::int64_t, std::int64_t>{{1, 80}}));
    EXPECT_EQ(read_nifti_grid(path).size, (Index3{38, 35, 38}));
}

}  // namespace
}  // namespace kontur
