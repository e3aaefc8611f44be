// SPDX-License-Identifier: Apache-2.0
// What every image format that kontur writes has to keep.

#include <limits>

#include "image_cases.h"
#include "kontur/io/image.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

struct ImageFormat {
    const char* name;
    std::vector<const char*> endings;  ///< of file names
    double geometry_error_mm;          ///< of corners, after writing: that of the header's numbers
    double oracle_error_mm;            ///< of corners: between kontur and the independent reader
    const char* oracle_command;        ///< makes files
    int oracle_files;                  ///< how many of them have an expectation
};

void PrintTo(const ImageFormat& format, std::ostream* out) { *out << format.name; }

class ImageFormats : public ::testing::TestWithParam<ImageFormat> {
protected:
    const ImageFormat& format() const { return GetParam(); }

    /// A name that no file has, with the next ending in turn.
    fs::path next_path() {
        const std::size_t n = static_cast<std::size_t>(files_++);
        return folder / (std::to_string(n) + format().endings[n % format().endings.size()]);
    }

    test::TemporaryFolder folder;

private:
    int files_ = 0;
};

TEST_P(ImageFormats, WriteThenReadIsIdentityInAllOrientations) {
    for (const Grid& grid : test::all_orientations())
        for (std::size_t ending = 0; ending < format().endings.size(); ++ending) {
            const fs::path path = next_path();
            const Image image = test::pattern_image<std::int16_t>(grid);
            write_image(path, image);
            const Image again = read_image(path);
            EXPECT_LE(corner_distance_mm(image.grid, again.grid), format().geometry_error_mm) << path;
            EXPECT_EQ(read_grid(path), again.grid) << path;
            EXPECT_EQ(again.samples, image.samples) << path;
        }
}

TEST_P(ImageFormats, KeepsEveryValueOfEverySampleType) {
    const Grid grid = test::all_orientations()[5];
    const auto check = [&](const Image& image) {
        const fs::path path = next_path();
        write_image(path, image);
        test::expect_same_values(read_image(path), image, path.string());
    };
    check(test::pattern_image<std::uint8_t>(grid));
    check(test::pattern_image<std::int16_t>(grid));
    check(test::pattern_image<float>(grid));
    Image labels = test::pattern_image<std::uint16_t>(grid);
    std::get<std::vector<std::uint16_t>>(labels.samples)[3] = std::numeric_limits<std::uint16_t>::max();
    check(labels);
    Image large = test::pattern_image<std::int32_t>(grid);
    std::get<std::vector<std::int32_t>>(large.samples)[3] = std::numeric_limits<std::int32_t>::min();
    check(large);
}

TEST_P(ImageFormats, AnIndependentReaderReadsWhatIsWritten) {
    int number = 0;
    const auto write = [&](const Image& image) {
        const fs::path path = next_path();
        Provenance facts;
        if (number++ % 3 == 0) facts = {{"made_by", "kontur"}};
        write_image(path, image, {}, facts);
        // The tolerance is that of the numbers in the file, which read_grid sees as well.
        Image stored = image;
        stored.grid = read_grid(path);
        EXPECT_LE(corner_distance_mm(stored.grid, image.grid), format().geometry_error_mm);
        test::write_expectation(path, stored, format().oracle_error_mm);
    };
    for (const Grid& grid : test::all_orientations()) write(test::pattern_image<std::int16_t>(grid));
    const Grid grid = test::all_orientations().back();
    write(test::pattern_image<std::uint8_t>(grid));
    write(test::pattern_image<std::uint16_t>(grid));
    write(test::pattern_image<std::int32_t>(grid));
    write(test::pattern_image<float>(grid));
    test::run_image_oracle("check", folder.path());
}

TEST_P(ImageFormats, ReadsWhatAnIndependentWriterWrites) {
    test::run_image_oracle(format().oracle_command, folder.path());
    EXPECT_EQ(test::compare_with_expectations(folder.path(), [](const fs::path& path) { return read_image(path); }),
              format().oracle_files);
}

TEST_P(ImageFormats, RefusesEveryTruncatedPrefix) {
    for (const char* ending : format().endings) {
        const fs::path whole = folder / (std::string("whole") + ending), part = folder / (std::string("part") + ending);
        write_image(whole, test::pattern_image<std::int16_t>(test::all_orientations()[50]));
        test::expect_prefixes_refused(whole, part, [](const fs::path& path) { read_image(path); });
    }
}

INSTANTIATE_TEST_SUITE_P(, ImageFormats,
                         ::testing::Values(ImageFormat{"MetaImage", {".mha"}, 1e-12, 1e-9, "make-metaimage", 59},
                                           // Single precision at the origin's distance; nibabel computes MGH with it.
                                           ImageFormat{"Mgh", {".mgh", ".mgz"}, 1e-3, 1e-4, "make-mgh", 22},
                                           ImageFormat{"Nifti", {".nii", ".nii.gz"}, 5e-4, 1e-6, "make-nifti", 59},
                                           ImageFormat{"Nrrd", {".nrrd"}, 0, 1e-9, "make-nrrd", 91}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace kontur
