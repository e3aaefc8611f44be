// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/model_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/expect_error.h"
#include "support/random.h"
#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

DrawnContour oblique_contour() {
    std::mt19937 random = kontur::test::random_of_this_test();
    std::normal_distribution<double> normal;
    DrawnContour contour = test::freehand_circle(30);
    contour.plane = make_plane({1.23456789012345, -7e-5, 300}, {normal(random), normal(random), normal(random)});
    for (Vec3& p : contour.points) p = contour.plane.from_uv(normal(random), normal(random));
    contour.control = {{contour.points[0], Stretch::wire, 0, 1}, {contour.points[7], Stretch::spline, 7}};
    contour.hole = true;
    contour.visible = false;
    return contour;
}

TEST(ModelJson, AContourReturnsToTheLastBit) {
    const DrawnContour contour = oblique_contour();
    EXPECT_EQ(contour_from_json(json::parse(to_text(to_json(contour)))), contour);
}

TEST(ModelJson, AStructureReturns) {
    const Structure structure{12,
                              "Leber \"links\"",
                              "#a0B1c2",
                              false,
                              {make_plane({1, 2, 3}, {0, 0.6, 0.8})},
                              1e-4,
                              {{{1, 2, 3.3}, {}}, {{4, 5, 6}, Vec3{0, 0, 1}}}};
    EXPECT_EQ(structure_from_json(json::parse(to_text(to_json(structure)))), structure);
}

TEST(ModelJson, NamesThatAreNoUtf8DoNotThrow) {
    EXPECT_NO_THROW(json::parse(to_text(to_json(Structure{1, "Leb\xe4r", "#000000", true}))));
}

TEST(ModelJson, EveryMissingOrWrongMemberIsNamed) {
    const json whole = to_json(oblique_contour());
    for (const auto& [key, value] : whole.items()) {
        if (key == "kind") continue;  // follows from the stretches
        json without = whole, wrong = whole;
        without.erase(key);
        wrong[key] = "?";
        EXPECT_THROW(contour_from_json(wrong), Error) << key;
        if (key == "closed") continue;  // projects of before have none
        EXPECT_KONTUR_ERROR(contour_from_json(without), ErrorKind::invalid_input,
                            key == "control" ? "control" : "'" + key + "'");
    }
}

TEST(ModelJson, AnOpenLineReturnsAndAContourOfAProjectOfBeforeIsClosed) {
    DrawnContour line = oblique_contour();
    line.closed = line.hole = false;
    line.inside = Hand::right;
    json told = json::parse(to_text(to_json(line)));
    EXPECT_EQ(contour_from_json(told), line);
    told["hole"] = true;
    EXPECT_KONTUR_ERROR(contour_from_json(told), ErrorKind::invalid_input, "open and a hole");
    told["hole"] = false;
    told.erase("closed");
    EXPECT_KONTUR_ERROR(contour_from_json(told), ErrorKind::invalid_input, "closed and says on which hand");
    told.erase("inside");
    EXPECT_TRUE(contour_from_json(told).closed);
}

TEST(ModelJson, AKeyThatStandsTwiceIsRefused) {
    EXPECT_KONTUR_ERROR(parsed(R"({"call": "undo", "call": "redo"})"), ErrorKind::invalid_input,
                        "\"call\" stands there twice");
    EXPECT_KONTUR_ERROR(parsed(R"({"a": [{"x": 1, "x": 1}]})"), ErrorKind::invalid_input, "twice in a 1");
    EXPECT_EQ(parsed(R"({"a": {"x": 1}, "b": {"x": 1}})")["b"]["x"], 1);
    EXPECT_THROW(parsed("{"), json::exception);
}

TEST(ModelJson, NumbersBeyondTheirLimitsAreRefused) {
    const json object{{"id", 1.5},          {"huge", 1e19},    {"unsigned", 18446744073709551615u},
                      {"far", {0, 0, 1e7}}, {"short", {0, 0}}, {"zero", 0}};
    const Members m(object);
    EXPECT_KONTUR_ERROR(m.id("id"), ErrorKind::invalid_input, "whole number");
    EXPECT_KONTUR_ERROR(m.id("huge"), ErrorKind::invalid_input, "whole number");
    EXPECT_KONTUR_ERROR(m.id("unsigned"), ErrorKind::invalid_input, "whole number");
    EXPECT_KONTUR_ERROR(m.id("zero"), ErrorKind::invalid_input, "whole number");
    EXPECT_KONTUR_ERROR(m.point("far"), ErrorKind::invalid_input, "limit is 1e+06 mm");
    EXPECT_KONTUR_ERROR(m.point("short"), ErrorKind::invalid_input, "[x, y, z]");
}

TEST(ModelJson, WhatIsStoredMayBeLargerThanWhatIsSent) {
    json far = to_json(oblique_contour());
    far["points"][3] = {5e6, 0, 0};
    EXPECT_KONTUR_ERROR(contour_from_json(far), ErrorKind::invalid_input, "limit is 1e+06 mm");
    EXPECT_EQ(contour_from_json(far, kStoredLimits).points[3].x, 5e6);
}

TEST(ModelJson, DeepNestingIsRefusedBeforeItIsRead) {
    const auto nested = [](int depth) {
        const auto count = static_cast<std::size_t>(depth);
        return std::string(count, '[') + std::string(count, ']');
    };
    EXPECT_NO_THROW(parsed(nested(kDeepest)));
    EXPECT_KONTUR_ERROR(parsed(nested(kDeepest + 1)), ErrorKind::invalid_input, "nested deeper than 64 levels");
    EXPECT_KONTUR_ERROR(parsed(std::string(1'000'000, '{')), ErrorKind::invalid_input, "nested deeper");
    const std::string text = "\\\"" + nested(100);
    EXPECT_EQ(parsed(json(text).dump()), text) << "brackets in a text nest nothing";
    EXPECT_THROW(parsed("[\"\\"), json::exception);
}

TEST(ModelJson, APlaneIsMadeOrthonormalOrRefused) {
    const auto plane = [](const Vec3& u) {
        return json{{"plane", {{"origin", {0, 0, 0}}, {"normal", {0, 0, 1}}, {"u", to_json(u)}, {"v", {0, -1, 0}}}}};
    };
    const json skew = plane({1, 0, 5e-4});
    const Plane read = Members(skew).plane("plane");
    EXPECT_NEAR(dot(read.u, read.normal), 0, 1e-15);
    EXPECT_NEAR(norm(read.u), 1, 1e-15);
    EXPECT_LT(read.v.y, 0);
    const json bad = plane({0.9, 0, 0.436});
    EXPECT_KONTUR_ERROR(Members(bad).plane("plane"), ErrorKind::invalid_input, "not perpendicular");
}

}  // namespace
}  // namespace kontur::viewer
