// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/deflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "kontur/io/images/image_view.h"
#include "support/random.h"

namespace kontur {
namespace {

Mask ball_mask() {
    Mask mask{{{60, 50, 40}, Affine3{}}, {}};
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 50; ++j)
            for (int i = 0; i < 60; ++i) mask.values.push_back(norm(Vec3{i - 30.0, j - 25.0, k - 20.0}) < 15 ? 1 : 0);
    return mask;
}

std::string deflated(std::span<const std::byte> bytes, DeflateMode mode) {
    std::string packed;
    Deflater deflater(
        DeflateFormat::zlib,
        [&](const void* data, std::size_t count) { packed.append(static_cast<const char*>(data), count); }, mode);
    deflater.write(bytes);
    deflater.finish();
    return packed;
}

std::string inflated(const std::string& packed, std::size_t size) {
    std::string bytes(size, '\0');
    uLongf count = size;
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &count, reinterpret_cast<const Bytef*>(packed.data()),
                         packed.size()),
              Z_OK);
    EXPECT_EQ(count, size);
    return bytes;
}

TEST(Deflater, GivesTheBytesBackInEveryMode) {
    const Mask mask = ball_mask();
    const auto bytes = std::as_bytes(std::span(mask.values));
    const std::string expected(mask.values.begin(), mask.values.end());
    for (const DeflateMode mode : {DeflateMode::dense, DeflateMode::runs, DeflateMode::quick})
        EXPECT_EQ(inflated(deflated(bytes, mode), bytes.size()), expected);
    EXPECT_LT(deflated(bytes, DeflateMode::runs).size(), deflated(bytes, DeflateMode::dense).size()) << "masks are runs";
}

TEST(DeflateMode, LooksForRunsInMasksOnly) {
    const Mask mask = ball_mask();
    EXPECT_EQ(deflate_mode(mask), DeflateMode::runs);

    std::mt19937 random = test::random_of_this_test();
    Mask noise = mask;
    for (std::uint8_t& value : noise.values) value = static_cast<std::uint8_t>(random() % 256);
    EXPECT_EQ(deflate_mode(noise), DeflateMode::dense);

    const Image wide{mask.grid, std::vector<std::int16_t>(mask.values.begin(), mask.values.end())};
    EXPECT_EQ(deflate_mode(wide), DeflateMode::dense) << "of two bytes only zeros are runs";
}

}  // namespace
}  // namespace kontur
