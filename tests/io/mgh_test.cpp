// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/mgh.h"

#include "image_cases.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;
using test::expect_error;

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
