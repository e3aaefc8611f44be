// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/gipl.h"

#include "image_cases.h"
#include "kontur/io/image.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;
using test::expect_error;

class Gipl : public ::testing::Test {
protected:
    void SetUp() override {
        test::run_image_oracle("make-gipl", folder.path());
        told.allow_missing_geometry = true;
    }

    void expect_refused(std::size_t at, std::initializer_list<int> bytes, ErrorKind kind, const std::string& part) {
        std::string content = test::content_of(folder / "i2.gipl");
        for (const int byte : bytes) content[at++] = static_cast<char>(byte);
        test::put_content(folder / "b.gipl", content);
        expect_error(kind, part, [&] { read_gipl(folder / "b.gipl", told); });
    }

    test::TemporaryFolder folder;
    ReadImageOptions told;
};

TEST_F(Gipl, ReadsWhatAnIndependentWriterWrites) {
    EXPECT_EQ(test::compare_with_expectations(
                  folder.path(), [&](const fs::path& path) { return read_image(path, told); },
                  [&](const fs::path& path) { return read_grid(path, told); }),
              16);
}

TEST_F(Gipl, IsReadOnlyByThoseWhoKnowHowItLies) {
    expect_error(ErrorKind::unsupported, "allow_missing_geometry reads it along L, P, S",
                 [&] { read_image(folder / "i2.gipl"); });
}

TEST_F(Gipl, EveryTruncatedPrefixIsRefusedAndNoFlippedBitDoesMoreThanThrow) {
    const auto read = [&](const fs::path& path) { read_gipl(path, told); };
    for (const char* name : {"i2.gipl", "u1.gipl.gz"})
        test::expect_prefixes_refused(folder / name, folder / ("part-" + std::string(name)), read);
    test::expect_flips_survived(folder / "i2.gipl", folder / "spoiled.gipl", read);
}

TEST_F(Gipl, ContradictionsAreRefusedByName) {
    expect_refused(252, {0}, ErrorKind::corrupt_file, "no GIPL file");
    expect_refused(0, {0, 0}, ErrorKind::corrupt_file, "b.gipl");
    expect_refused(0, {0xff, 0xff, 0xff, 0xff, 0xff, 0xff}, ErrorKind::too_large, "at most");
    expect_refused(0, {0xff, 0xff}, ErrorKind::corrupt_file, "bytes of voxels, but only 120 are there");
    expect_refused(6, {0, 2}, ErrorKind::unsupported, "2 frames; choose one");
    expect_refused(8, {0, 144}, ErrorKind::unsupported, "samples are of type 144");
    expect_refused(10, {0, 0, 0, 0}, ErrorKind::corrupt_file, "spacing along axis 1 is 0 mm");
    expect_refused(204, {0x7f, 0xf8, 0, 0, 0, 0, 0, 0}, ErrorKind::corrupt_file, "b.gipl");
    expect_refused(240, {0x40, 0, 0, 0}, ErrorKind::unsupported, "rescaled by 2 and 0");
}

}  // namespace
}  // namespace kontur
