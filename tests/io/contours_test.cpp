// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours.h"

#include <gtest/gtest.h>

#include <fstream>

#include "kontur/base/error.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/contours/markups.h"
#include "support/contour_sets.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

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

TEST_F(Contours, ExtensionsMeanTheSameInCapitals) {
    write_contours(folder_ / "A.JSON", set_);
    write_contours(folder_ / "A.MRK.JSON", set_);
    EXPECT_EQ(read_contour_json(folder_ / "A.JSON").contours.size(), 3u);
    EXPECT_EQ(read_markups(folder_ / "A.MRK.JSON").contours.size(), 3u);
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

TEST_F(Contours, AStructureOfAnotherNameIsRefused) {
    for (const char* name : {"a.json", "a.mrk.json"}) {
        write_contours(folder_ / name, set_);
        EXPECT_EQ(point_count(read_contours(folder_ / name, {.roi = "kidney"}).contours), 60u);
        for (const char* roi : {"spleen", "1", ""}) try {
                read_contours(std::vector<fs::path>{folder_ / name}, {.roi = roi});
                ADD_FAILURE() << "accepted " << roi;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
                EXPECT_NE(std::string(error.what()).find("'kidney'"), std::string::npos) << error.what();
            }
    }
}

TEST_F(Contours, BesideAStructureSetTheRoiIsItsOwn) {
    KONTUR_REQUIRE_DATA("03_sarcoma_STS_002/CT/RTSTRUCT_RS.dcm");
    write_contours(folder_ / "a.json", set_);
    const std::vector<fs::path> both{test::data_dir() / "03_sarcoma_STS_002/CT/RTSTRUCT_RS.dcm", folder_ / "a.json"};
    EXPECT_EQ(read_contours(both, {.roi = "GTV_Mass_CT"}).contours.contours.size(), 19u);
}

TEST_F(Contours, RtStructureSetsAreReadByRoi) {
    KONTUR_REQUIRE_DATA("03_sarcoma_STS_002/CT/RTSTRUCT_RS.dcm");
    const fs::path sarcoma = test::data_dir() / "03_sarcoma_STS_002/CT/RTSTRUCT_RS.dcm";
    const ReadContours read = read_contours(sarcoma, {.roi = "GTV_Mass_CT"});
    EXPECT_EQ(read.contours.name, "GTV_Mass_CT");
    EXPECT_EQ(read.contours.contours.size(), 16u);
    EXPECT_NO_THROW(check_contours(read.contours));
    try {
        read_contours(sarcoma, {.roi = "spleen"});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("RTSTRUCT_RS.dcm"), std::string::npos) << error.what();
    }
}

TEST_F(Contours, RtStructureSetsSurviveAsContourFiles) {
    KONTUR_REQUIRE_DATA("04_sarcoma_STS_040/CT/RTSTRUCT_RS.dcm");
    const ContourSet set =
        read_contours(test::data_dir() / "04_sarcoma_STS_040/CT/RTSTRUCT_RS.dcm", {.roi = "GTV_Mass_CT"}).contours;
    for (const char* name : {"a.json", "a.mrk.json"}) {
        write_contours(folder_ / name, set);
        const ContourSet again = read_contours(folder_ / name).contours;
        ASSERT_EQ(again.contours.size(), set.contours.size());
        for (std::size_t i = 0; i < set.contours.size(); ++i) {
            EXPECT_EQ(again.contours[i].points, set.contours[i].points);
            EXPECT_EQ(again.contours[i].hole, set.contours[i].hole);
        }
    }
}

}  // namespace
}  // namespace kontur
