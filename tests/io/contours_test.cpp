// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours.h"

#include <gtest/gtest.h>

#include <fstream>

#include "kontur/base/error.h"
#include "kontur/io/contour_json.h"
#include "kontur/io/markups.h"
#include "support/contour_sets.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

class Contours : public testing::Test {
protected:
    Contours() : set_(test::three_circles()) { set_.name = "kidney"; }

    ErrorKind refusal_of(const fs::path& path) {
        try {
            read_contours(path);
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(path.filename().string()), std::string::npos) << error.what();
            return error.kind();
        }
        ADD_FAILURE() << "accepted " << path;
        return {};
    }

    ContourSet set_;
    test::TemporaryFolder folder_;
};

TEST_F(Contours, TheNameDecidesWhatIsWritten) {
    write_contours(folder_ / "a.json", set_);
    write_contours(folder_ / "a.mrk.json", set_);
    EXPECT_EQ(read_contour_json(folder_ / "a.json").contours.size(), 3u);
    EXPECT_EQ(read_markups(folder_ / "a.mrk.json").contours.size(), 3u);
    EXPECT_THROW(write_contours(folder_ / "a.dcm", set_), Error);
    EXPECT_FALSE(fs::exists(folder_ / "a.dcm"));
}

TEST_F(Contours, TheContentDecidesWhatIsRead) {
    write_markups(folder_ / "a.json", set_);
    write_contour_json(folder_ / "b.txt", set_);
    for (const char* name : {"a.json", "b.txt"}) {
        const ReadContours read = read_contours(folder_ / name);
        EXPECT_EQ(read.contours.name, "kidney");
        EXPECT_EQ(point_count(read.contours), 60u);
        EXPECT_TRUE(read.notes.empty());
    }
}

TEST_F(Contours, OtherFilesAreRefusedByName) {
    std::ofstream(folder_ / "picture.png") << "\x89PNG\r\n";
    std::ofstream(folder_ / "empty.json") << "";
    std::ofstream(folder_ / "list.json") << "[1, 2]";
    std::ofstream(folder_ / "cut.dcm") << std::string(128, '\0') << "DICM";
    EXPECT_EQ(refusal_of(folder_ / "picture.png"), ErrorKind::unsupported);
    EXPECT_EQ(refusal_of(folder_ / "empty.json"), ErrorKind::unsupported);
    EXPECT_EQ(refusal_of(folder_ / "list.json"), ErrorKind::corrupt_file);
    EXPECT_EQ(refusal_of(folder_ / "absent.json"), ErrorKind::io);
    EXPECT_EQ(refusal_of(folder_.path()), ErrorKind::io);
    EXPECT_THROW(read_contours(folder_ / "cut.dcm"), Error);
}

TEST_F(Contours, SeveralFilesBecomeOneObject) {
    ContourSet second = set_;
    second.name = "other";
    second.contours.resize(1);
    second.interior = {{1, 2, 3}};
    write_contours(folder_ / "a.mrk.json", set_);
    write_contours(folder_ / "b.json", second);
    const ReadContours read = read_contours(std::vector<fs::path>{folder_ / "a.mrk.json", folder_ / "b.json"});
    EXPECT_EQ(read.contours.name, "kidney");
    ASSERT_EQ(read.contours.contours.size(), 4u);
    EXPECT_EQ(read.contours.contours[3].points, second.contours[0].points);
    EXPECT_EQ(read.contours.interior, second.interior);
    EXPECT_TRUE(read_contours(std::vector<fs::path>{}).contours.contours.empty());
}

}  // namespace
}  // namespace kontur
