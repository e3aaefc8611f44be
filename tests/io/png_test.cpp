// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/png.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

TEST(WriteAnimatedPng, IndependentDecoderFindsEveryPixelOfEachPicture) {
    const test::TemporaryFolder folder;
    std::vector<RgbImage> pictures{noise(31, 17), noise(31, 17), noise(31, 17), noise(31, 17)};
    for (const int x : {4, 9}) pictures[1].bytes[3 * (5 * 31 + x) + 1] ^= 0xFF;
    pictures[2] = pictures[1];  // nothing changes
    std::reverse(pictures[3].bytes.begin(), pictures[3].bytes.end());
    write_animated_png(folder / "moving.png", pictures, 0.0414, {{"made_by", "hand"}});
    const auto python = test::run_python("decode_png.py", {folder / "moving.png", folder / "moving.raw"});
    ASSERT_EQ(python.exit_code, 0) << python.output;
    EXPECT_EQ(python.output, "31 17 41 41 41 41\n");
    std::string all;
    for (const RgbImage& picture : pictures) all.append(picture.bytes.begin(), picture.bytes.end());
    EXPECT_EQ(bytes_of(folder / "moving.raw"), all);
    EXPECT_LT(std::filesystem::file_size(folder / "moving.png"), 2.5 * 3 * 31 * 17) << "only what changes is written";
}

TEST(WriteAnimatedPng, RefusesWhatCannotMove) {
    const test::TemporaryFolder folder;
    const auto write = [&](const std::vector<RgbImage>& pictures, double seconds) {
        write_animated_png(folder / "moving.png", pictures, seconds);
    };
    EXPECT_KONTUR_ERROR(write({}, 1), ErrorKind::invalid_input, "there is no picture");
    EXPECT_KONTUR_ERROR(write({noise(4, 4), noise(4, 5)}, 1), ErrorKind::invalid_input,
                        "a picture of 4 x 5 pixels after one of 4 x 4");
    EXPECT_KONTUR_ERROR(write({noise(4, 4)}, 0), ErrorKind::invalid_input, "each picture is seen for 0 s");
    EXPECT_KONTUR_ERROR(write({noise(4, 4)}, NAN), ErrorKind::invalid_input, "each picture is seen for nan s");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
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
