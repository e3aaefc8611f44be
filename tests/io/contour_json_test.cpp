// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours/contour_json.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <sstream>

#include "kontur/base/error.h"
#include "support/damage.h"
#include "support/random.h"
#include "support/refusal.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSmall =
    R"({"frame": "LPS mm", "structure": "liver", "planes": [)"
    R"({"origin": [1, 2, 3], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0], "contours": [)"
    R"({"closed": true, "hole": false, "points": [[0, 0, 3], [4, 0, 3], [4, 4, 3]]},)"
    R"({"closed": true, "hole": true, "points": [[1, 0, 3], [2, 0, 3], [2, 1, 3]]}]},)"
    R"({"origin": [0, 0, 9], "normal": [0, 3, 4], "contours": [{"points": [[5, 0, 9], [6, 8, 3], [7, 0, 9]]}]}]})";

std::string replaced(std::string_view what, std::string_view with) {
    std::string text(kSmall);
    const std::size_t at = text.find(what);
    if (at == std::string::npos) throw std::logic_error("not in the sample: " + std::string(what));
    return text.replace(at, what.size(), with);
}

std::string content_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

class ContourJson : public testing::Test {
protected:
    fs::path file(std::string_view text) {
        std::ofstream(folder_ / "in.json", std::ios::binary) << text;
        return folder_ / "in.json";
    }
    ContourSet read(std::string_view text) { return read_contour_json(file(text)); }
    std::string refusal(std::string_view text, ErrorKind kind = ErrorKind::corrupt_file) {
        return test::refusal_of(folder_ / "in.json", kind, [&] { read(text); });
    }
    ContourSet written_and_read(const ContourSet& set) {
        write_contour_json(folder_ / "out.json", set);
        return read_contour_json(folder_ / "out.json");
    }

    test::TemporaryFolder folder_;
};

void expect_same(const ContourSet& a, const ContourSet& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.interior, b.interior);
    EXPECT_EQ(a.exterior, b.exterior);
    EXPECT_EQ(a.surface, b.surface);
    EXPECT_EQ(a.empty_planes, b.empty_planes);
    EXPECT_EQ(a.cycle_frames, b.cycle_frames);
    EXPECT_EQ(a.cycle_s, b.cycle_s);
    ASSERT_EQ(a.contours.size(), b.contours.size());
    for (std::size_t i = 0; i < a.contours.size(); ++i) {
        EXPECT_EQ(a.contours[i].plane, b.contours[i].plane) << "contour " << i;
        EXPECT_EQ(a.contours[i].points, b.contours[i].points) << "contour " << i;
        EXPECT_EQ(a.contours[i].closed, b.contours[i].closed);
        EXPECT_EQ(a.contours[i].hole, b.contours[i].hole);
        EXPECT_EQ(a.contours[i].end, b.contours[i].end);
        EXPECT_EQ(a.contours[i].inside, b.contours[i].inside);
        EXPECT_EQ(a.contours[i].weight, b.contours[i].weight);
        EXPECT_EQ(a.contours[i].frame, b.contours[i].frame);
        EXPECT_EQ(a.contours[i].time_s, b.contours[i].time_s);
    }
}

void expect_orthonormal(const Plane& plane) {
    EXPECT_NEAR(norm(plane.normal), 1, 1e-12);
    EXPECT_NEAR(norm(plane.u), 1, 1e-12);
    EXPECT_NEAR(norm(plane.v), 1, 1e-12);
    EXPECT_NEAR(dot(plane.u, plane.v), 0, 1e-12);
    EXPECT_NEAR(dot(plane.normal, plane.u), 0, 1e-12);
    EXPECT_NEAR(dot(plane.normal, plane.v), 0, 1e-12);
}

TEST_F(ContourJson, ReadsPlanesHolesAndDefaults) {
    const ContourSet set = read(kSmall);
    EXPECT_EQ(set.name, "liver");
    ASSERT_EQ(set.contours.size(), 3u);
    EXPECT_EQ(set.contours[0].plane, (Plane{{1, 2, 3}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(set.contours[1].points, (std::vector<Vec3>{{1, 0, 3}, {2, 0, 3}, {2, 1, 3}}));
    EXPECT_FALSE(set.contours[0].hole);
    EXPECT_TRUE(set.contours[1].hole);
    EXPECT_TRUE(set.contours[2].closed) << "closed unless the file says otherwise";
    EXPECT_LT(distance(set.contours[2].plane.normal, {0, 0.6, 0.8}), 1e-15) << "any length gives a direction";
    expect_orthonormal(set.contours[2].plane);
}

TEST_F(ContourJson, RasIsTurnedIntoLps) {
    const ContourSet set = read(replaced("LPS mm", "RAS mm"));
    EXPECT_EQ(set.contours[0].points[1], (Vec3{-4, 0, 3}));
    EXPECT_EQ(set.contours[0].plane, (Plane{{-1, -2, 3}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}));
    EXPECT_LT(distance(set.contours[2].plane.normal, {0, -0.6, 0.8}), 1e-15);
    EXPECT_LT(std::abs(set.contours[2].plane.distance_to(set.contours[2].points[1])), 1e-12);
}

TEST_F(ContourJson, RoundedAxesBecomeOrthonormalAndKeepTheirHandedness) {
    const ContourSet set =
        read(replaced(R"("u": [1, 0, 0], "v": [0, 1, 0])", R"("u": [0.999999, 1e-6, 1e-6], "v": [0, -1, 2e-6])"));
    expect_orthonormal(set.contours[0].plane);
    EXPECT_LT(set.contours[0].plane.v.y, -0.9);
}

TEST_F(ContourJson, DropsALastPointThatRepeatsTheFirst) {
    const ContourSet set = read(replaced("[4, 4, 3]]", "[4, 4, 3], [0, 0, 3]]"));
    EXPECT_EQ(set.contours[0].points.size(), 3u);
}

TEST_F(ContourJson, OpenContoursKeepTheirEndsAndSayWhereTheObjectLies) {
    const ContourSet set =
        read(replaced(R"("closed": true, "hole": false, "points": [[0, 0, 3], [4, 0, 3], [4, 4, 3])",
                      R"("closed": false, "inside": "right", "points": [[0, 0, 3], [4, 0, 3], [0, 0, 3])"));
    EXPECT_FALSE(set.contours[0].closed);
    EXPECT_EQ(set.contours[0].inside, Hand::right);
    EXPECT_EQ(set.contours[0].points.size(), 3u) << "a stretch may end where it began";
    EXPECT_FALSE(set.contours[1].inside);
}

TEST_F(ContourJson, ReadsEndsAndSurfacePoints) {
    const ContourSet set = read(replaced(R"([7, 0, 9]]}]}]})", R"([7, 0, 9]], "end": "round"}]}],
                      "surface": [[1, 2, 3], {"point": [4, 5, 6], "outward": [0, 3, 4]}, {"point": [7, 8, 9]}]})"));
    EXPECT_EQ(set.contours[0].end, ContourEnd::automatic);
    EXPECT_EQ(set.contours[2].end, ContourEnd::round);
    ASSERT_EQ(set.surface.size(), 3u);
    EXPECT_EQ(set.surface[0], (SurfacePoint{{1, 2, 3}, {}}));
    EXPECT_EQ(set.surface[2], (SurfacePoint{{7, 8, 9}, {}}));
    EXPECT_EQ(set.surface[1].position, (Vec3{4, 5, 6}));
    EXPECT_LT(distance(set.surface[1].outward.value(), {0, 0.6, 0.8}), 1e-15);
}

TEST_F(ContourJson, ContoursWeighOneUnlessTheFileSaysOtherwise) {
    const ContourSet set = read(replaced(R"("hole": true)", R"("hole": true, "weight": 0.25)"));
    EXPECT_EQ(set.contours[0].weight, 1);
    EXPECT_EQ(set.contours[1].weight, 0.25);
}

TEST_F(ContourJson, AContourMayHaveAMomentAndADrawingWithoutAnyHasNoWordOfIt) {
    const ContourSet set = read(replaced(R"("hole": true)", R"("hole": true, "frame": 7)"));
    EXPECT_FALSE(set.contours[0].frame.has_value());
    EXPECT_EQ(set.contours[1].frame, 7);
    write_contour_json(folder_ / "plain.json", read(kSmall));
    for (const char* word : {"\"frame\": 1", "time_s", "cycle"})
        EXPECT_EQ(content_of(folder_ / "plain.json").find(word), std::string::npos) << word;
}

TEST_F(ContourJson, RefusesMeaningsThatItDoesNotKnow) {
    EXPECT_NE(refusal(replaced(R"("hole": true)", R"("end": "pointed")"))
                  .find(R"(contour 2: 'end' is "pointed"; "flat" or "round" is expected)"),
              std::string::npos);
    EXPECT_NE(refusal(replaced(R"("hole": true)", R"("weight": "much")")).find("'weight' is text, not a number"),
              std::string::npos);
    EXPECT_NE(refusal(replaced(R"("hole": true)", R"("frame": "first")")).find("'frame' is text, not a number"),
              std::string::npos);
    EXPECT_NE(refusal(replaced(R"("hole": true)", R"("inside": "up")")).find(R"('inside' is "up"; "left" or "right")"),
              std::string::npos);
    EXPECT_NE(refusal(replaced(R"("planes": [)", R"("surface": [{"point": [1, 2, 3], "outward": [0, 0, 0]}], "planes": [)"))
                  .find("surface: point 1: outward: has length 0"),
              std::string::npos);
}

TEST_F(ContourJson, RefusalsNameThePlace) {
    EXPECT_NE(refusal(replaced("[2, 0, 3]", "[2, null, 3]")).find("plane 1: contour 2: point 2: y is null, not a number"),
              std::string::npos);
    EXPECT_NE(refusal(replaced("[6, 8, 3]", "[6, 8]")).find("plane 2: contour 1: point 2: has 2 items"), std::string::npos);
    EXPECT_NE(refusal(replaced("[6, 8, 3]", "\"x\"")).find("plane 2: contour 1: point 2: is text"), std::string::npos);
    EXPECT_NE(refusal(replaced("[0, 3, 4]", "[0, 0, 0]")).find("plane 2: normal: has length 0"), std::string::npos);
    EXPECT_NE(
        refusal(replaced("\"u\": [1, 0, 0]", "\"u\": [1, 0, 1]")).find("plane 1: normal, u and v are not perpendicular"),
        std::string::npos);
    EXPECT_NE(refusal(replaced("\"origin\": [0, 0, 9], ", "")).find("plane 2: origin: 'origin' is missing"),
              std::string::npos);
    EXPECT_NE(refusal(replaced("\"hole\": true", "\"hole\": 1")).find("plane 1: contour 2: 'hole' is a number"),
              std::string::npos);
    EXPECT_NE(refusal(replaced("\"u\": [1, 0, 0], ", "")).find("plane 1: has 'v' without 'u'"), std::string::npos);
    EXPECT_NE(refusal(R"({"frame": "LPS mm", "planes": 7})").find("'planes' is a number, not an array"), std::string::npos);
    EXPECT_NE(refusal("[]").find("is an array, not an object"), std::string::npos);
}

TEST_F(ContourJson, NumberBeyondDoubleIsRefusedWithItsPlace) {
    EXPECT_NE(refusal(replaced("[2, 0, 3]", "[2, 1e999, 3]"))
                  .find("the number 1e999 is out of range in planes 1, contours 2, points 2, item 2"),
              std::string::npos);
    EXPECT_NE(refusal(replaced("[2, 0, 3]", "[2, NaN, 3]")).find("is not valid JSON from byte"), std::string::npos);
}

TEST_F(ContourJson, AKeyThatStandsTwiceIsRefusedWithItsPlace) {
    const auto told = [&](const std::string& text) { return refusal(text); };
    EXPECT_NE(told(replaced("{\"frame\"", "{\"frame\": \"RAS mm\", \"frame\"")).find("the key \"frame\" stands there twice"),
              std::string::npos)
        << "the last one would mirror the patient";
    EXPECT_NE(told(replaced("\"hole\": true", "\"hole\": true, \"h\\u006fle\": false"))
                  .find("the key \"hole\" stands there twice in planes 1, contours 2"),
              std::string::npos)
        << "however it is written";
    EXPECT_NE(
        told(replaced("\"planes\"", "\"unknown\": [{\"a\": {\"b\": 1, \"b\": 1}}], \"planes\"")).find("in unknown 1, a"),
        std::string::npos)
        << "where kontur looks at nothing, too";
}

TEST_F(ContourJson, RefusesToWriteANameThatIsNoUtf8) {
    ContourSet set;
    set.name = "Leb\xe4r";
    EXPECT_THROW(write_contour_json(folder_ / "a.json", set), Error);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.json"));
}

TEST_F(ContourJson, OtherDocumentsAreToldApart) {
    EXPECT_NE(refusal(R"({"version": "1.0.0", "contours": 7})").find("holds no contours"), std::string::npos);
}

TEST_F(ContourJson, OtherFramesAndVersionsAreUnsupported) {
    EXPECT_NE(refusal(replaced("LPS mm", "LAS mm"), ErrorKind::unsupported).find("\"LAS mm\""), std::string::npos);
    EXPECT_NE(refusal(replaced("\"frame\": \"LPS mm\", ", "")).find("'frame' is missing"), std::string::npos);
    EXPECT_NE(refusal(replaced("{\"frame\"", "{\"version\": 2, \"frame\""), ErrorKind::unsupported).find("version is 2"),
              std::string::npos);
}

TEST_F(ContourJson, MissingFileIsAnIoError) {
    try {
        read_contour_json(folder_ / "absent.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::io);
        EXPECT_NE(std::string(error.what()).find("absent.json: No such file"), std::string::npos) << error.what();
    }
    EXPECT_THROW(read_contour_json(folder_.path()), Error) << "a folder";
}

TEST_F(ContourJson, EveryTruncatedPrefixIsRefused) {
    for (std::size_t length = 0; length < kSmall.size(); ++length) refusal(kSmall.substr(0, length));
}

TEST_F(ContourJson, FlippedBytesNeverDoMoreThanThrow) {
    test::for_each_mutant(std::string(kSmall), 2000, 1, [&](const std::string& text) {
        try {
            read(text);
        } catch (const Error&) {
        }
    });
}

TEST_F(ContourJson, DeepNestingIsRefusedWithoutExhaustingTheStack) {
    EXPECT_LT(refusal(std::string(1'000'000, '[')).size(), 500u);
}

TEST_F(ContourJson, TextGivesWhatItsFileGives) {
    const ContourSet set = parse_contour_json(kSmall);
    EXPECT_EQ(to_contour_json(set), to_contour_json(read(kSmall)));
    EXPECT_EQ(set.contours.size(), 3u);
    EXPECT_EQ(parse_planes_json(kSmall), read_planes_json(file(kSmall)));
    EXPECT_TRUE(parse_confirmed_planes_json(kSmall).empty());
    write_contour_json(folder_ / "out.json", set);
    EXPECT_EQ(content_of(folder_ / "out.json"), to_contour_json(set));
    try {
        parse_contour_json(replaced("[4, 0, 3]", "[4, 0]"));
        ADD_FAILURE() << "a point of two numbers was taken";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "plane 1: contour 1: point 2: has 2 items, not the 3 numbers x, y, z");
    }
}

TEST_F(ContourJson, WritingAndReadingGivesTheSameDoubles) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> number(-1000, 1000);
    const auto vector = [&] { return Vec3{number(random), number(random), number(random)}; };
    ContourSet set{"a \"name\"\n with ü", {}, {vector(), vector()}, {vector()}, {{vector(), {}}}};
    set.surface.push_back({vector(), normalized(vector())});
    for (int i = 0; i < 40; ++i) {
        const Plane plane = i % 3 ? set.contours.back().plane : make_plane(vector(), vector());
        Contour contour{plane, {}, i % 5 != 0, i % 4 == 0};
        for (int p = 0; p < i; ++p) contour.points.push_back(vector());
        if (contour.closed) contour.end = std::array{ContourEnd::automatic, ContourEnd::flat, ContourEnd::round}[i % 3];
        else if (i % 2) contour.inside = i % 3 ? Hand::left : Hand::right;
        if (i % 7 == 0) contour.weight = 0.001 + 0.1 * i;
        if (i % 3 == 0) contour.frame = 1 + 0.1 * i;
        if (i % 3 == 1) contour.time_s = -0.7 * i;
        set.contours.push_back(contour);
    }
    set.cycle_frames = 20;
    set.cycle_s = 0.83;
    set.contours[5].points[0] = {1e-300, 0.1 + 0.2, std::numeric_limits<double>::max()};
    expect_same(set, written_and_read(set));
    const std::string first = content_of(folder_ / "out.json");
    written_and_read(written_and_read(set));
    EXPECT_EQ(content_of(folder_ / "out.json"), first) << "the bytes settle at once";
}

TEST_F(ContourJson, KeepsWhatFilesSayOfTheStructure) {
    ContourSet set = read(kSmall);
    EXPECT_EQ(set.attributes, StructureAttributes{}) << "of a file that says nothing";
    const auto without_attributes = content_of((write_contour_json(folder_ / "plain.json", set), folder_ / "plain.json"));
    EXPECT_EQ(without_attributes.find("color"), std::string::npos);
    set.attributes = {.color = {{0, 128, 255}},
                      .interpreted_type = "GTV",
                      .generation_algorithm = "MANUAL",
                      .description = "\"L\xC3\xA4sion\"\nsecond line \\",
                      .number = 17,
                      .category = {{"49755003", "SCT", "Morphologically Altered Structure"}},
                      .code = {{"4147007", "SCT", "Mass"}},
                      .physical_properties = {{"REL_ELEC_DENSITY", 1.1}, {"EFFECTIVE_Z", 7}},
                      .review = {Approval{"Doe^J\xC3\xB6rg", "2026-11-30T21:02:43"}, "cropped\nto the body", true}};
    const ContourSet again = written_and_read(set);
    EXPECT_EQ(again.attributes, set.attributes);
    expect_same(again, set);
}

TEST_F(ContourJson, RefusesAttributesThatMakeNoSense) {
    const auto refused = [&](std::string_view members) {
        return refusal(replaced("\"structure\": \"liver\"", members)).substr((folder_ / "in.json").string().size() + 2);
    };
    EXPECT_EQ(refused(R"("color": "red")"), "color: is no list of red, green and blue");
    EXPECT_EQ(refused(R"("color": [0, 0, 256])"), "color: has the level 256; whole numbers from 0 to 255 are possible");
    EXPECT_EQ(refused(R"("color": [0, 0, 0.5])"), "color: has the level 0.5; whole numbers from 0 to 255 are possible");
    EXPECT_EQ(refused(R"("number": "3")"), "number: is \"3\", not a whole number");
    EXPECT_EQ(refused(R"("number": 18446744073709551615)"), "number: is 18446744073709551615, not a whole number");
    EXPECT_EQ(refused(R"("code": {"value": "1"})"), "code: has no value or no scheme");
    EXPECT_EQ(refused(R"("physical_properties": [{"property": "A", "value": null}])"),
              "physical_properties: item 1: the value is null, not a number");
    EXPECT_EQ(refused(R"("review": true)"), "review: is no object");
    EXPECT_EQ(refused(R"("review": {"approved": "Doe"})"), "review: approved: is no object");
    EXPECT_EQ(refused(R"("review": {"approved": {"by": "Doe", "at": "yesterday"}})"),
              "review: approved: 'at' is \"yesterday\", not a time like 2026-11-30T21:02:43");
    EXPECT_NE(refused(R"("review": {"locked": 1})").find("locked"), std::string::npos);
    ContourSet set = read(kSmall);
    set.attributes.physical_properties = {{"A", std::numeric_limits<double>::infinity()}};
    EXPECT_THROW(written_and_read(set), Error);
    set.attributes = {.description = "Leb\xe4r"};
    EXPECT_THROW(written_and_read(set), Error);
    set.attributes = {.review = {.approved = Approval{"J\xf6rg", ""}}};
    EXPECT_THROW(written_and_read(set), Error);
}

TEST_F(ContourJson, AnEmptySetIsWrittenAndRead) { expect_same(ContourSet{}, written_and_read(ContourSet{})); }

TEST_F(ContourJson, NeighboursOnOnePlaneShareAnEntryAndALineEach) {
    const ContourSet set = read(kSmall);
    written_and_read(set);
    EXPECT_EQ(read_planes_json(folder_ / "out.json").size(), 2u);
    const std::string text = content_of(folder_ / "out.json");
    EXPECT_NE(text.find("\n    {\"closed\": true, \"hole\": true, \"points\": [[1, 0, 3], [2, 0, 3], [2, 1, 3]]}\n"),
              std::string::npos)
        << text;
}

TEST_F(ContourJson, RefusesToWriteWhatJsonCannotHold) {
    ContourSet set = read(kSmall);
    set.contours[1].points[0].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(write_contour_json(folder_ / "out.json", set), Error);
    EXPECT_FALSE(fs::exists(folder_ / "out.json"));
}

TEST_F(ContourJson, PlanesNeedNoContours) {
    const fs::path path = file(R"({"frame": "LPS mm", "planes": [{"origin": [1, 2, 3], "normal": [0, 2, 0]},
                                   {"origin": [0, 0, 0], "normal": [0, 0, 1], "u": [0, 1, 0], "contours": []}]})");
    const std::vector<Plane> planes = read_planes_json(path);
    ASSERT_EQ(planes.size(), 2u);
    EXPECT_EQ(planes[0].normal, (Vec3{0, 1, 0}));
    EXPECT_EQ(planes[1], (Plane{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}));
    EXPECT_TRUE(read_contour_json(path).contours.empty());
}

TEST_F(ContourJson, EmptyPlanesAreReadInTheirFrameAndHaveNoContours) {
    const ContourSet set =
        read(R"({"frame": "RAS mm", "planes": [], "empty_planes": [{"origin": [1, 2, 3], "normal": [0, 2, 0]}]})");
    ASSERT_EQ(set.empty_planes.size(), 1u);
    EXPECT_EQ(set.empty_planes[0].origin, (Vec3{-1, -2, 3}));
    EXPECT_EQ(set.empty_planes[0].normal, (Vec3{0, -1, 0}));
    EXPECT_NE(refusal(R"({"frame": "LPS mm", "planes": [], "empty_planes": [{"origin": [1, 2, 3], "normal": [0, 2, 0],
                        "contours": [{"points": []}]}]})")
                  .find("empty_planes: plane 1: has contours"),
              std::string::npos);
}

TEST_F(ContourJson, WrittenFilesFulfilTheSchema) {
    ContourSet set = read(kSmall);
    write_contour_json(folder_ / "plain.json", set);
    write_contour_json(folder_ / "empty.json", {});
    set.interior = {{1, 2, 3}};
    set.exterior = {{4, 5, 6}, {1e22, 1e-9, 0}};
    set.surface = {{{4, 5, 6}, {}}, {{1, 2, 3}, Vec3{0, 0, 1}}};
    set.empty_planes = {make_plane({1, 2, 3}, {0, 0.6, 0.8}), make_plane({}, {1, 0, 0})};
    expect_same(written_and_read(set), set);
    set.contours[0].end = ContourEnd::flat;
    set.contours[2].closed = false;
    set.contours[2].inside = Hand::left;
    set.contours[2].weight = 2.5;
    write_contour_json(folder_ / "points.json", set);
    const std::string schema = test::support_folder() + "/../../docs/contours.schema.json";
    const auto valid = test::run_python(
        "validate_json.py", {schema, folder_ / "plain.json", folder_ / "empty.json", folder_ / "points.json", file(kSmall)});
    EXPECT_EQ(valid.exit_code, 0) << valid.output;
    const auto invalid = test::run_python("validate_json.py", {schema, file(replaced("[2, 0, 3]", "[2, null, 3]"))});
    EXPECT_EQ(invalid.exit_code, 1) << invalid.output;
}

TEST_F(ContourJson, RealFilesFulfilTheSchema) {
    const std::string real = "derived_nonparallel/hippocampus_label5/radial6.json";
    KONTUR_REQUIRE_DATA(real);
    const std::string schema = test::support_folder() + "/../../docs/contours.schema.json";
    const auto valid = test::run_python("validate_json.py", {schema, test::data_dir() / real});
    EXPECT_EQ(valid.exit_code, 0) << valid.output;
}

/// The sorted contour files of the real non-parallel cuts.
std::vector<std::string> real_files() {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(test::data_dir() / "derived_nonparallel"))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

TEST_F(ContourJson, RealSetsHoldWhatPythonFindsInThem) {
    KONTUR_REQUIRE_DATA("derived_nonparallel");
    const std::vector<std::string> files = real_files();
    ASSERT_EQ(files.size(), 30u);
    const auto described = test::run_python("describe_contours.py", files);
    ASSERT_EQ(described.exit_code, 0) << described.output;
    std::istringstream lines(described.output);
    for (const std::string& name : files) {
        SCOPED_TRACE(name);
        std::size_t planes = 0, contours = 0, points = 0;
        std::ptrdiff_t holes = 0;
        double total = 0;
        ASSERT_TRUE(lines >> planes >> contours >> holes >> points >> total);
        const ContourSet set = read_contour_json(name);
        EXPECT_EQ(set.name, fs::path(name).parent_path().filename());
        EXPECT_EQ(read_planes_json(name).size(), planes);
        EXPECT_EQ(set.contours.size(), contours);
        EXPECT_EQ(std::count_if(set.contours.begin(), set.contours.end(), [](const Contour& c) { return c.hole; }), holes);
        EXPECT_EQ(point_count(set), points);
        double sum = 0;
        for (const Contour& contour : set.contours)
            for (const Vec3& p : contour.points) sum += p.x + p.y + p.z;
        EXPECT_NEAR(sum, total, 1e-6);
        EXPECT_NO_THROW(check_contours(set));
        for (const Plane& plane : read_planes_json(name)) expect_orthonormal(plane);
        expect_same(set, written_and_read(set));
    }
}

}  // namespace
}  // namespace kontur
