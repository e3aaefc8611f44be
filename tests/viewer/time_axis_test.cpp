// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/time_axis.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace kontur::viewer {
namespace {

std::shared_ptr<const Image> image_of(std::int16_t value) {
    return std::make_shared<const Image>(Image{{{10, 10, 10}, {}}, std::vector<std::int16_t>(1000, value)});
}

TEST(TimeAxis, ReadsATimeOnceAsLongAsThereIsRoom) {
    const auto own = image_of(2);
    std::vector<int> read;
    const auto reader = [&](int time) {
        read.push_back(time);
        return image_of(static_cast<std::int16_t>(time));
    };
    TimeAxis times(own, {.count = 5, .own = 2, .read = reader}, 2 * 2000);
    EXPECT_EQ(times.image(2), own);
    for (const int time : {0, 1, 0, 1}) EXPECT_EQ(sample(*times.image(time), 0), time);
    EXPECT_EQ(read, (std::vector{0, 1}));
    times.image(4);  // 1 was used last, so 0 goes
    times.image(1);
    times.image(0);
    EXPECT_EQ(read, (std::vector{0, 1, 4, 0}));
}

TEST(TimeAxis, RefusesATimeThatThereIsNot) {
    TimeAxis alone(image_of(0), {});
    EXPECT_KONTUR_ERROR(alone.image(1), ErrorKind::invalid_input, "there is no time 1: the last one is time 0");
    EXPECT_KONTUR_ERROR(alone.image(-1), ErrorKind::invalid_input, "there is no time -1");
}

TEST(TimeAxis, ATimeThatCannotBeReadIsSaidEachTime) {
    TimeAxis times(image_of(0), {.count = 2, .read = [](int) -> std::shared_ptr<const Image> {
                                     throw Error(ErrorKind::io, "it is gone");
                                 }});
    for (int n = 0; n < 2; ++n) EXPECT_KONTUR_ERROR(times.image(1), ErrorKind::io, "it is gone");
}

}  // namespace
}  // namespace kontur::viewer
