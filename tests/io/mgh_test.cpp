// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/mgh.h"

#include <limits>

#include "image_cases.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;
using test::expect_error;

/// Single precision at the origin's distance, twice.
constexpr double kFloatErrorMm = 1e-3;

TEST(Mgh, WriteThenReadIsIdentityInAllOrientations) {
    const test::TemporaryFolder folder;
    int number = 0;
    for (const Grid& grid : test::all_orientations())
        for (const char* suffix : {".mgh", ".mgz"}) {
            const fs::path path = folder / (std::to_string(number++) + suffix);
            const Image image = test::pattern_image<std::int16_t>(grid);
            write_mgh(path, image);
            const Image again = read_mgh(path);
            EXPECT_LT(corner_distance_mm(image.grid, again.grid), kFloatErrorMm) << path;
            EXPECT_EQ(read_mgh_grid(path), again.grid) << path;
            EXPECT_EQ(again.samples, image.samples) << path;
        }
}

TEST(Mgh, KeepsEveryValue) {
    const test::TemporaryFolder folder;
    const Grid grid = test::all_orientations()[5];
    const auto check = [&](const Image& image) {
        write_mgh(folder / "a.mgz", image);
        test::expect_same_values(read_mgh(folder / "a.mgz"), image, "sample type " + std::to_string(image.samples.index()));
    };
    check(test::pattern_image<std::uint8_t>(grid));
    check(test::pattern_image<std::int16_t>(grid));
    check(test::pattern_image<float>(grid));
    Image labels = test::pattern_image<std::uint16_t>(grid);
    std::get<std::vector<std::uint16_t>>(labels.samples)[3] = 65535;
    check(labels);
    Image large = test::pattern_image<std::int32_t>(grid);
    std::get<std::vector<std::int32_t>>(large.samples)[3] = std::numeric_limits<std::int32_t>::min();
    check(large);
}

TEST(Mgh, NibabelReadsWhatIsWritten) {
    const test::TemporaryFolder folder;
    int number = 0;
    const auto write = [&](const Image& image) {
        const fs::path path = folder / (std::to_string(number) + (number % 2 ? ".mgh" : ".mgz"));
        ImageView view(image);
        if (number % 3 == 0) view.provenance = {{"made_by", "kontur"}};
        write_mgh(path, view);
        Image stored = image;
        stored.grid = read_mgh_grid(path);
        test::write_expectation(path, stored, 1e-4);  // nibabel computes with single precision
        ++number;
    };
    for (const Grid& grid : test::all_orientations()) write(test::pattern_image<std::int16_t>(grid));
    const Grid grid = test::all_orientations().back();
    write(test::pattern_image<std::uint8_t>(grid));
    write(test::pattern_image<std::uint16_t>(grid));
    write(test::pattern_image<std::int32_t>(grid));
    write(test::pattern_image<float>(grid));
    test::run_image_oracle("check", folder.path());
}

TEST(Mgh, ReadsWhatNibabelWrites) {
    const test::TemporaryFolder folder;
    test::run_image_oracle("make-mgh", folder.path());
    EXPECT_EQ(test::compare_with_expectations(folder.path(), [](const fs::path& path) { return read_mgh(path); }), 22);
}

TEST(Mgh, AHeaderWithoutGeometryIsReadAsFreeSurferDoesOnlyWhenTold) {
    const test::TemporaryFolder folder;
    test::run_image_oracle("make-mgh", folder.path());
    const fs::path path = folder / "lost" / "lost.mgh";
    expect_error(ErrorKind::unsupported, "goodRASFlag is 0", [&] { read_mgh(path); });
    ReadImageOptions options;
    options.allow_missing_geometry = true;
    EXPECT_LT(corner_distance_mm(read_mgh_grid(path, options), test::read_expectation(path).image.grid), 1e-6);
}

class DamagedMgh : public ::testing::Test {
protected:
    void SetUp() override { write_mgh(folder / "a.mgh", test::pattern_image<std::int16_t>(test::all_orientations()[50])); }

    void expect_refused(std::size_t at, std::initializer_list<int> bytes, ErrorKind kind, const std::string& part) {
        std::string content = test::content_of(folder / "a.mgh");
        for (const int byte : bytes) content[at++] = static_cast<char>(byte);
        test::put_content(folder / "b.mgh", content);
        expect_error(kind, part, [&] { read_mgh(folder / "b.mgh"); });
    }

    test::TemporaryFolder folder;
};

TEST_F(DamagedMgh, EveryTruncatedPrefixIsRefused) {
    const auto read = [](const fs::path& path) { read_mgh(path); };
    test::expect_prefixes_refused(folder / "a.mgh", folder / "part.mgh", read);
    write_mgh(folder / "a.mgz", test::pattern_image<std::int16_t>(test::all_orientations()[50]));
    test::expect_prefixes_refused(folder / "a.mgz", folder / "part.mgz", read);
}

TEST_F(DamagedMgh, ContradictionsAreRefusedByName) {
    expect_refused(3, {2}, ErrorKind::corrupt_file, "version 1");
    expect_refused(4, {0, 0, 0, 0}, ErrorKind::corrupt_file, "0");
    expect_refused(4, {0x7f, 0xff, 0xff, 0xff}, ErrorKind::too_large, "at most");
    expect_refused(4, {0, 0x7f, 0xff, 0xff}, ErrorKind::corrupt_file, "bytes of voxels, but only 48 are there");
    expect_refused(4, {0xff, 0xff, 0xff, 0xff}, ErrorKind::corrupt_file, "b.mgh");
    expect_refused(16, {0, 0, 0, 0}, ErrorKind::corrupt_file, "0 frames");
    expect_refused(16, {0, 0, 0, 2}, ErrorKind::unsupported, "2 frames; choose one");
    expect_refused(20, {0, 0, 0, 2}, ErrorKind::unsupported, "samples are of type 2");
    expect_refused(30, {0x7f, 0xc0, 0, 0}, ErrorKind::corrupt_file, "b.mgh");
    expect_refused(30, {0, 0, 0, 0}, ErrorKind::corrupt_file, "b.mgh");
}

}  // namespace
}  // namespace kontur
