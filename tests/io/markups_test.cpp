// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours/markups.h"
#include "kontur/io/contours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "kontur/base/error.h"
#include "support/contour_sets.h"
#include "support/damage.h"
#include "support/refusal.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSmall =
    R"({"@schema": "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/)"
    R"(markups-schema-v1.0.3.json#", "markups": [{"type": "ClosedCurve", "name": "Lesion", "coordinateSystem": "LPS", )"
    R"("coordinateUnits": "mm", "locked": false, "controlPoints": [)"
    R"({"id": "1", "position": [13.0, -11.0, 112.5], "positionStatus": "defined"},)"
    R"({"id": "2", "position": [5.0, -3.0, 112.5], "positionStatus": "defined"},)"
    R"({"id": "3", "position": [-3.0, -11.0, 112.5]}]}]})";

std::string replaced(std::string_view what, std::string_view with) {
    std::string text(kSmall);
    const std::size_t at = text.find(what);
    if (at == std::string::npos) throw std::logic_error("not in the sample: " + std::string(what));
    return text.replace(at, what.size(), with);
}

class Markups : public testing::Test {
protected:
    ContourSet read(std::string_view text, const ReadMarkupsOptions& options = {.curves = Curves::polygon}) {
        std::ofstream(folder_ / "in.mrk.json", std::ios::binary) << text;
        return read_markups(folder_ / "in.mrk.json", options);
    }
    std::string refusal(std::string_view text, ErrorKind kind) {
        return test::refusal_of(folder_ / "in.mrk.json", kind, [&] { read(text); });
    }
    ContourSet written_and_read(const ContourSet& set) {
        write_markups(folder_ / "out.mrk.json", set);
        return read_markups(folder_ / "out.mrk.json");
    }

    test::TemporaryFolder folder_;
};

TEST_F(Markups, ReadsAClosedCurveWithItsPlane) {
    const ContourSet set = read(kSmall);
    EXPECT_EQ(set.name, "Lesion");
    ASSERT_EQ(set.contours.size(), 1u);
    EXPECT_EQ(set.contours[0].points, (std::vector<Vec3>{{13, -11, 112.5}, {5, -3, 112.5}, {-3, -11, 112.5}}));
    EXPECT_TRUE(set.contours[0].closed);
    EXPECT_FALSE(set.contours[0].hole);
    EXPECT_NEAR(std::abs(set.contours[0].plane.normal.z), 1, 1e-12);
    EXPECT_NO_THROW(check_contours(set));
}

TEST_F(Markups, TextGivesWhatItsFileGives) {
    const ContourSet from_text = parse_markups(kSmall, {.curves = Curves::polygon}), from_file = read(kSmall);
    EXPECT_EQ(from_text.name, from_file.name);
    ASSERT_EQ(from_text.contours.size(), 1u);
    EXPECT_EQ(from_text.contours[0].points, from_file.contours[0].points);
}

TEST_F(Markups, FramesByNameAndByNumber) {
    const Vec3 lps{13, -11, 112.5}, ras{-13, 11, 112.5};
    for (const auto& [text, first] : std::vector<std::pair<std::string, Vec3>>{
             {"\"LPS\"", lps}, {"\"1\"", lps}, {"1", lps}, {"\"RAS\"", ras}, {"\"0\"", ras}, {"0", ras}})
        EXPECT_EQ(read(replaced("\"LPS\"", text)).contours[0].points[0], first) << text;
    EXPECT_EQ(read(replaced("\"coordinateSystem\": \"LPS\", ", "")).contours[0].points[0], lps) << "the schema's default";
    EXPECT_NE(refusal(replaced("\"LPS\"", "\"IJK\""), ErrorKind::unsupported).find("\"IJK\""), std::string::npos);
}

TEST_F(Markups, UnitsByCodeAloneOrWithItsScheme) {
    EXPECT_EQ(read(replaced("\"mm\"", R"(["mm", "UCUM", "millimeter"])")).contours[0].points[0].z, 112.5);
    EXPECT_DOUBLE_EQ(read(replaced("\"mm\"", "\"um\"")).contours[0].points[0].z, 0.1125);
    EXPECT_NE(refusal(replaced("\"mm\"", "\"cm\""), ErrorKind::unsupported).find("\"cm\""), std::string::npos);
}

TEST_F(Markups, LeavesOutPointsWithoutAPosition) {
    for (const char* extra : {R"({"id": "4", "position": "", "positionStatus": "undefined"})",
                              R"({"id": "4", "position": [1.0, 2.0, 3.0], "positionStatus": "preview"})", R"({"id": "4"})"})
        EXPECT_EQ(read(replaced("112.5]}]", std::string("112.5]}, ") + extra + "]")).contours[0].points.size(), 3u) << extra;
}

TEST_F(Markups, OtherTypesAreRefusedByName) {
    for (const char* type : {"Line", "Angle", "Plane", "ROI", "curve", ""})
        EXPECT_NE(refusal(replaced("ClosedCurve", type), ErrorKind::unsupported).find(std::string("type \"") + type + "\""),
                  std::string::npos);
    EXPECT_NE(refusal(replaced("schema-v1.0.3", "schema-v2.0.0"), ErrorKind::unsupported).find("schema-v2.0.0"),
              std::string::npos);
}

TEST_F(Markups, OpenCurvesAreStretchesOfTheBoundary) {
    const ContourSet set = read(replaced("ClosedCurve", "Curve"));
    ASSERT_EQ(set.contours.size(), 1u);
    EXPECT_FALSE(set.contours[0].closed);
    EXPECT_EQ(set.contours[0].points.size(), 3u);
    EXPECT_NO_THROW(check_contours(set));
}

TEST_F(Markups, ASplineRunsThroughEachPointWithinThePlaneAndSaysHowFarItIsOff) {
    std::vector<double> off_mm;
    const ContourSet set = read(kSmall, {.on_spline = [&](double mm) { off_mm.push_back(mm); }});
    ASSERT_EQ(set.contours.size(), 1u);
    const std::vector<Vec3>& points = set.contours[0].points;
    for (const Vec3& control : {Vec3{13, -11, 112.5}, Vec3{5, -3, 112.5}, Vec3{-3, -11, 112.5}})
        EXPECT_EQ(std::ranges::count(points, control), 1);
    for (const Vec3& p : points) EXPECT_NEAR(p.z, 112.5, 1e-12);
    EXPECT_EQ(points.size(), 30u);
    ASSERT_EQ(off_mm.size(), 1u);
    // With three points the slope at each is the vector between the other two; half way from the first to the second point:
    EXPECT_TRUE(std::ranges::any_of(points, [](const Vec3& p) { return distance(p, {12, -6, 112.5}) < 1e-9; }));
    EXPECT_NEAR(off_mm[0], 2 * std::sqrt(2.0), 1e-9);
    EXPECT_NO_THROW(check_contours(set));
}

TEST_F(Markups, AStraightOpenCurveLiesInAPlaneParallelToAnothers) {
    const std::string curves = replaced(R"("positionStatus": "defined"},)"
                                        R"({"id": "3", "position": [-3.0, -11.0, 112.5]}]}]})",
                                        R"("positionStatus": "defined"},)"
                                        R"({"id": "3", "position": [-3.0, -11.0, 112.5]}]},)"
                                        R"({"type": "Curve", "name": "Lesion 2", "controlPoints": [)"
                                        R"({"position": [0.0, 0.0, 120.0]}, {"position": [9.0, 4.0, 120.0]}]}]})");
    const ContourSet set = read(curves);
    ASSERT_EQ(set.contours.size(), 2u);
    EXPECT_NEAR(std::abs(set.contours[1].plane.normal.z), 1, 1e-12);
    EXPECT_EQ(set.contours[1].plane.distance_to({3, 3, 120}), 0);
    EXPECT_NO_THROW(check_contours(set));
    std::string across = curves;
    across.replace(across.find("9.0, 4.0, 120.0"), 15, "9.0, 4.0, 121.0");
    EXPECT_NE(refusal(across, ErrorKind::invalid_input).find("no other curve tells in which plane"), std::string::npos);
}

TEST_F(Markups, PointListsAreSinglePoints) {
    const ContourSet set = read(replaced(
        R"("markups": [)", R"("markups": [{"type": "Fiducial", "coordinateSystem": "RAS", "controlPoints": [)"
                           R"({"position": [1.0, 2.0, 3.0]}, {"position": [4.0, 5.0, 6.0], "description": "inside"},)"
                           R"({"position": [7.0, 8.0, 9.0], "description": "outside"}]}, )"));
    EXPECT_EQ(set.name, "Lesion") << "after the curves";
    ASSERT_EQ(set.contours.size(), 1u);
    EXPECT_EQ(set.surface, (std::vector<SurfacePoint>{{{-1, -2, 3}, {}}}));
    EXPECT_EQ(set.interior, (std::vector<Vec3>{{-4, -5, 6}}));
    EXPECT_EQ(set.exterior, (std::vector<Vec3>{{-7, -8, 9}}));
}

TEST_F(Markups, WritesOpenCurvesAndSinglePoints) {
    ContourSet set = test::three_circles();
    set.name = "liver";
    set.contours[1].closed = false;
    set.interior = {{0, 0, 0.5}};
    set.exterior = {{90, 0, 0}, {0, 90, 0}};
    set.surface = {{{1, 2, 3}, {}}};
    const ContourSet again = written_and_read(set);
    EXPECT_EQ(again.name, "liver");
    ASSERT_EQ(again.contours.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(again.contours[i].points, set.contours[i].points);
        EXPECT_EQ(again.contours[i].closed, i != 1);
    }
    EXPECT_EQ(again.interior, set.interior);
    EXPECT_EQ(again.exterior, set.exterior);
    EXPECT_EQ(again.surface, set.surface);
}

TEST_F(Markups, LeavesOutACurveWithoutAPoint) {
    const char* const kFile =
        R"({"@schema": "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/markups-schema-v1.0.3.json#",
        "markups": [{"type": "ClosedCurve", "coordinateSystem": "LPS", "name": "begun", "controlPoints": []},
        {"type": "ClosedCurve", "coordinateSystem": "LPS", "name": "whole", "controlPoints":
         [{"position": [0, 0, 5]}, {"position": [9, 0, 5]}, {"position": [9, 9, 5]}]}]})";
    std::ofstream(folder_ / "begun.mrk.json") << kFile;
    const ReadContours found = read_contours(folder_ / "begun.mrk.json", {.roi = {}, .curves = Curves::polygon});
    EXPECT_EQ(found.contours.contours.size(), 1u);
    EXPECT_EQ(found.contours.name, "whole");
    EXPECT_EQ(found.notes, (std::vector<std::string>{"left out 1 curve without a point"}));
}

TEST_F(Markups, RefusalsNameMarkupPointNumberAndLimit) {
    EXPECT_NE(refusal(replaced("[5.0, -3.0, 112.5]", "[5.0, null, 112.5]"), ErrorKind::corrupt_file)
                  .find("markup 1: control point 2: y is null, not a number"),
              std::string::npos);
    EXPECT_NE(refusal(replaced(R"(112.5], "positionStatus": "defined")", R"(112.5], "positionStatus": "undefined")"),
                      ErrorKind::invalid_input)
                  .find("markup 1: has 2 points with a position; at least 3 are needed"),
              std::string::npos);
    EXPECT_NE(refusal(replaced("[5.0, -3.0, 112.5]", "[5.0, -11.0, 112.5]"), ErrorKind::invalid_input)
                  .find("markup 1: its 3 points lie on one line"),
              std::string::npos);
    refusal("[]", ErrorKind::corrupt_file);
    refusal(R"({"@schema": "markups-schema-v1.0.0.json#"})", ErrorKind::corrupt_file);
}

TEST_F(Markups, ACurveThatIsNotPlanarIsRefusedWithTheDistance) {
    ContourSet set = test::three_circles();
    for (std::size_t i = 0; i < 20; ++i) set.contours[1].points[i] += (i % 2 ? 0.5 : -0.5) * set.contours[1].plane.normal;
    write_markups(folder_ / "bent.mrk.json", set);
    try {
        read_markups(folder_ / "bent.mrk.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        EXPECT_NE(std::string(error.what()).find("markup 2: is not planar: points lie up to 0.5 mm off"), std::string::npos)
            << error.what();
    }
    EXPECT_NO_THROW(read_markups(folder_ / "bent.mrk.json", {.plane_tolerance_mm = 0.6}));
}

TEST_F(Markups, WritingAndReadingGivesTheSamePointsHolesAndName) {
    ContourSet set = test::three_circles();
    set.name = "liver \"left\" ü";
    set.contours[1].hole = true;
    const ContourSet again = written_and_read(set);
    EXPECT_EQ(again.name, set.name);
    ASSERT_EQ(again.contours.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(again.contours[i].points, set.contours[i].points);
        EXPECT_EQ(again.contours[i].hole, i == 1);
        EXPECT_NEAR(std::abs(dot(again.contours[i].plane.normal, set.contours[i].plane.normal)), 1, 1e-12);
    }
}

TEST_F(Markups, KeepsTheColourUnlessItIsTheOneOfAllMarkups) {
    ContourSet set = test::three_circles();
    set.attributes = {.color = {{0, 128, 255}}, .interpreted_type = "GTV"};
    EXPECT_EQ(written_and_read(set).attributes, (StructureAttributes{.color = {{0, 128, 255}}}));
    set.attributes.color = {{255, 128, 128}};
    EXPECT_EQ(written_and_read(set).attributes, StructureAttributes{});
}

TEST_F(Markups, NamesSurviveNumbersOfTheirOwn) {
    ContourSet set = test::three_circles();
    for (const char* name : {"", "L5", "CC_1"}) {
        set.name = name;
        set.contours.resize(1);
        EXPECT_EQ(written_and_read(set).name, name);
    }
    set.name = "T12";
    set.contours.resize(12, set.contours[0]);
    EXPECT_EQ(written_and_read(set).name, "T12");
}

TEST_F(Markups, WholeNumbersKeepTheirDecimalPoint) {
    ContourSet set;
    set.contours.push_back({Plane{}, {{0, 0, 0}, {100, 0, 0}, {0, 12345678, 0}}, true, false});
    write_markups(folder_ / "out.mrk.json", set);
    std::ostringstream text;
    text << std::ifstream(folder_ / "out.mrk.json").rdbuf();
    EXPECT_NE(text.str().find("[100.0,0.0,0.0]"), std::string::npos) << text.str();
    EXPECT_EQ(read_markups(folder_ / "out.mrk.json").contours[0].points, set.contours[0].points);
}

TEST_F(Markups, RefusesToWriteWhatIsNoNumber) {
    ContourSet broken = test::three_circles(), points = broken;
    points.surface = {{{0, std::numeric_limits<double>::quiet_NaN(), 0}, {}}};
    broken.contours[2].points[0].x = std::numeric_limits<double>::infinity();
    for (const ContourSet& set : {points, broken}) EXPECT_THROW(write_markups(folder_ / "out.mrk.json", set), Error);
    EXPECT_FALSE(fs::exists(folder_ / "out.mrk.json"));
}

TEST_F(Markups, EveryTruncatedPrefixIsRefused) {
    for (std::size_t length = 0; length < kSmall.size(); ++length)
        refusal(kSmall.substr(0, length), ErrorKind::corrupt_file);
}

TEST_F(Markups, FlippedBytesNeverDoMoreThanThrow) {
    test::for_each_mutant(std::string(kSmall), 2000, 1, [&](const std::string& text) {
        try {
            read(text);
        } catch (const Error&) {
        }
    });
}

}  // namespace
}  // namespace kontur
