// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/image_frames.h"

#include <algorithm>

#include "support/dicom_series_fixture.h"
#include "support/expect_error.h"
#include "support/file_opens.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

/// What the slow, obvious way reads: each frame by its number, which looks through the whole folder.
Image frame_by_number(const ImageSource& image, std::int64_t frame) {
    ReadImageOptions options = image.options;
    options.frame = frame;
    return read_image(image.path, options);
}

int most(const std::map<std::string, int>& counts) {
    int found = 0;
    for (const auto& [name, count] : counts) found = std::max(found, count);
    return found;
}

int sum(const std::map<std::string, int>& counts) {
    int found = 0;
    for (const auto& [name, count] : counts) found += count;
    return found;
}

/// Each frame opens its own files once, and the same voxels come as by its number.
void check_frames(const fs::path& folder, std::int64_t count, std::size_t files_of_one) {
    const ImageSource image{folder, {}};
    test::FileOpens opens(folder);
    const ImageFrames frames = read_image_frames(folder);
    ASSERT_EQ(frames.count, count);
    EXPECT_LE(most(opens.counts()), 6) << "kinds of file are told apart by their first bytes, each header is read once";
    for (std::int64_t n = 1; n <= count; ++n) {
        const ImageSource one = source_of_frame(image, frames, n);
        const Image read = read_image(one.path, one.options);
        const auto counts = opens.counts();
        EXPECT_EQ(counts.size(), files_of_one) << "frame " << n;
        EXPECT_LE(most(counts), 2) << "frame " << n;
        EXPECT_EQ(read_grid(one.path, one.options), read.grid);
        opens.counts();
        const Image slow = frame_by_number(image, n);
        EXPECT_GT(sum(opens.counts()), 2 * sum(counts)) << "or the slow way shows nothing";
        EXPECT_EQ(read.grid, slow.grid);
        EXPECT_EQ(read.samples, slow.samples);
    }
    EXPECT_KONTUR_ERROR(source_of_frame(image, frames, count + 1), ErrorKind::invalid_input,
                        "has no frame 5; it has 1 to 4");
}

class ImageFramesTest : public test::DicomSeriesTest {};

TEST_F(ImageFramesTest, AFrameOfAFolderOpensItsFileAlone) {
    for (int n = 1; n <= 4; ++n) {
        Image image{{{3, 4, 5}, {}}, std::vector<std::int16_t>(60, static_cast<std::int16_t>(n))};
        write_image(folder_ / ("frame " + std::to_string(n) + ".nrrd"), image);
    }
    check_frames(folder_.path(), 4, 1);
}

TEST_F(ImageFramesTest, AVolumeOfACineOpensItsSlicesAlone) { check_frames(make("cine"), 4, 5); }

TEST_F(ImageFramesTest, APhaseOfABreathOpensItsSlicesAlone) { check_frames(make("breath"), 4, 5); }

}  // namespace
}  // namespace kontur
