// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/png.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "support/expect_error.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

RgbImage noise(int width, int height) {
    std::mt19937 random(3);
    RgbImage image{width, height, {}};
    for (int i = 0; i < 3 * width * height; ++i) image.bytes.push_back(static_cast<std::uint8_t>(random()));
    return image;
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(WritePng, IndependentDecoderFindsSizeAndEveryPixel) {
    const test::TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {640, 401}}) {
        const RgbImage image = noise(width, height);
        write_png(folder / "picture.png", image);
        const auto python = test::run_python("decode_png.py", {folder / "picture.png", folder / "picture.raw"});
        ASSERT_EQ(python.exit_code, 0) << python.output;
        EXPECT_EQ(python.output, std::to_string(width) + " " + std::to_string(height) + "\n");
        const std::string raw = bytes_of(folder / "picture.raw");
        EXPECT_TRUE(std::equal(raw.begin(), raw.end(), image.bytes.begin(), image.bytes.end(),
                               [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }));
    }
}

TEST(WritePng, SamePictureGivesTheSameBytes) {
    const test::TemporaryFolder folder;
    write_png(folder / "a.png", noise(50, 40));
    write_png(folder / "b.png", noise(50, 40));
    EXPECT_EQ(bytes_of(folder / "a.png"), bytes_of(folder / "b.png"));
}

TEST(EncodePng, GivesTheBytesOfTheFile) {
    const test::TemporaryFolder folder;
    write_png(folder / "a.png", noise(50, 40), {{"made_by", "hand"}});
    EXPECT_EQ(encode_png(noise(50, 40), {{"made_by", "hand"}}), bytes_of(folder / "a.png"));
    EXPECT_KONTUR_ERROR(encode_png(RgbImage{}), ErrorKind::invalid_input, "0 x 0");
}

TEST(WritePng, RefusesWhatIsNoPictureAndLeavesNothingBehind) {
    const test::TemporaryFolder folder;
    EXPECT_KONTUR_ERROR(write_png(folder / "a.png", RgbImage{}), ErrorKind::invalid_input, "0 x 0");
    RgbImage lacking = noise(4, 4);
    lacking.bytes.pop_back();
    EXPECT_KONTUR_ERROR(write_png(folder / "a.png", lacking), ErrorKind::invalid_input, "47 bytes");
    EXPECT_KONTUR_ERROR(write_png(folder / "missing" / "a.png", noise(4, 4)), ErrorKind::io, "a.png");
    EXPECT_EQ(folder.entry_count(), 0);
}

}  // namespace
}  // namespace kontur
