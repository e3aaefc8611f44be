// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/server/http_api.h"

namespace kontur::viewer {
namespace {

using kontur::test::TemporaryFolder;
using nlohmann::json;

/// A session on a flat image with a project of its own.
struct SessionHere {
    TemporaryFolder folder;
    Session session{{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}}, folder.path() / "a.kontur"};
};

HttpRequest slice(const std::string& view, const json& page) {
    json body{
        {"view", view},
        {"plane", {{"origin", {0, 0, 0}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}, {"mm_per_pixel", 1}}},
        {"width", 8},
        {"height", 8},
        {"window", {{"center", 0}, {"width", 1}}}};
    if (!page.is_null()) body["page"] = page;
    return {"POST", {"/api/slice", {}}, body.dump()};
}

/// Status of the first of two requests that wait together.
int status_before(Session& session, const HttpRequest& first, const HttpRequest& second) {
    Workspace workspace(std::shared_ptr<Session>(&session, [](Session*) {}));
    HttpApi api(workspace);
    const auto answer = api.prepare(first);
    api.prepare(second);
    return answer({}).status;
}

TEST(Session, ASliceIsOvertakenByItsOwnPagesOnly) {
    SessionHere here;
    EXPECT_EQ(status_before(here.session, slice("axial", {}), slice("axial", {})), 409);
    EXPECT_EQ(status_before(here.session, slice("axial", {}), slice("coronal", {})), 200);
    EXPECT_EQ(status_before(here.session, slice("axial", "one"), slice("axial", "one")), 409);
    EXPECT_EQ(status_before(here.session, slice("axial", "one"), slice("axial", "two")), 200);
    EXPECT_EQ(status_before(here.session, slice("axial", "one"), slice("axial", {})), 200);
    HttpRequest second = slice("axial", {});
    json body = json::parse(second.body);
    body["image"] = 1;
    second.body = body.dump();
    EXPECT_EQ(status_before(here.session, slice("axial", {}), second), 200) << "a view shows both images";
    EXPECT_EQ(status_before(here.session, slice("axial", std::string(65, 'x')), slice("b", {})), 400);
    EXPECT_EQ(status_before(here.session, slice("axial", 7), slice("b", {})), 400);
}

ContourSet circles(int count, std::size_t points) {
    ContourSet set;
    set.name = "Rings";
    for (int i = 0; i < count; ++i) set.contours.push_back({test::kPlane, test::circle(points), true, false});
    return set;
}

TEST(Session, ImportsEndWhereAPageCouldNotBeToldOfAllPoints) {
    SessionHere here;
    here.session.add_structures("Import", {circles(1, 20)});
    EXPECT_KONTUR_ERROR(here.session.add_structures("Import", {circles(20, 100'000)}), ErrorKind::too_large,
                        "would hold 2000020 points; the limit is 2000000");
    EXPECT_EQ(here.session.state().structures.size(), 1u);
}

TEST(Session, NamesOfFilesBecomeWholeCharactersThatCanBeReadAgain) {
    SessionHere here;
    ContourSet set = circles(1, 20);
    set.name = "\xff" + std::string(97, 'x') + "\xc3\xa4\xc3\xa4";
    const Id id = here.session.add_structures("Import", {set}).front();
    EXPECT_EQ(here.session.state().structures.at(id).name, "\xef\xbf\xbd" + std::string(97, 'x'));
}

json called(Session& session, json message) {
    message["seq"] = 1;
    return json::parse(session.call(message.dump()));
}

json circle_to_add(Id structure, const char* origin) {
    json control = json::array();
    for (const Vec3& p : test::circle(24)) control.push_back({{"at", {p.x, p.y, p.z}}, {"kind", "spline"}});
    const Plane& at = test::kPlane;
    const auto numbers = [](const Vec3& p) { return json{p.x, p.y, p.z}; };
    json plane{{"origin", numbers(at.origin)}, {"u", numbers(at.u)}, {"v", numbers(at.v)}, {"normal", numbers(at.normal)}};
    return {{"call", "contour.add"}, {"structure", structure}, {"plane", plane}, {"control", control}, {"origin", origin}};
}

TEST(Session, TheHistoryNamesWhatAContourWasMadeOf) {
    SessionHere here;
    const Id id = here.session.add_structures("Import", {circles(1, 20)}).front();
    for (const auto& [origin, label] : {std::pair("drawn", "Draw a contour"), std::pair("pulled", "Pull the outline"),
                                        std::pair("pushed", "Push the outline"), std::pair("adopted", "Keep the outline"),
                                        std::pair("proposed", "Accept the proposal")}) {
        EXPECT_TRUE(called(here.session, circle_to_add(id, origin)).contains("result")) << origin;
        EXPECT_EQ(called(here.session, {{"call", "undo"}})["result"]["label"], label);
    }
    const json refusal = called(here.session, circle_to_add(id, "stolen"));
    EXPECT_EQ(refusal["error"]["kind"], "invalid_input");
    EXPECT_EQ(refusal["error"]["message"], R"('origin' is "stolen"; drawn, pulled, pushed, adopted or proposed is needed)");
}

json arc_to_add(Id structure) {
    json message = circle_to_add(structure, "drawn");
    message["plane"]["origin"] = {20, 20, 20};
    message["closed"] = false;
    message["control"].erase(message["control"].begin() + 16, message["control"].end());
    return message;
}

TEST(Session, AnOpenLineIsDrawnClosedAndOpenedAgain) {
    SessionHere here;
    const Id structure = here.session.add_structures("Import", {circles(1, 20)}).front();
    const json drawn = called(here.session, arc_to_add(structure))["result"]["contour"];
    ASSERT_FALSE(drawn["closed"]);
    const json id = drawn["id"];
    const auto contour = [&] { return *here.session.state().contours.at(id.get<Id>()); };
    EXPECT_EQ(contour().points.back(), contour().control.back().at);
    const std::vector<Vec3> before = contour().points;
    EXPECT_TRUE(
        called(here.session, {{"call", "contour.set"}, {"id", id}, {"closed", true}})["result"]["contour"]["closed"]);
    EXPECT_GT(contour().points.size(), before.size());
    EXPECT_EQ(called(here.session, {{"call", "undo"}})["result"]["label"], "Close a line");
    EXPECT_EQ(contour().points, before);
    called(here.session, {{"call", "redo"}});
    const Vec3 gap = test::circle(24)[3];
    const json opened =
        called(here.session, {{"call", "contour.set"}, {"id", id}, {"closed", false}, {"at", {gap.x, gap.y + 0.1, gap.z}}});
    EXPECT_FALSE(opened["result"]["contour"]["closed"]) << opened;
    EXPECT_EQ(contour().points.back(), test::circle(24)[3]) << "the stretch behind it is gone";
    EXPECT_EQ(called(here.session, {{"call", "undo"}})["result"]["label"], "Open a contour");
}

TEST(Session, TheSideOfAnOpenLineIsFoundAndCanBeTold) {
    SessionHere here;
    ContourSet set = circles(1, 40);
    set.contours.push_back(set.contours.front());
    Contour& arc = set.contours.back();
    for (Vec3& p : arc.points) p = {p.x, 20, p.y};
    arc.points.resize(24);
    arc.plane = {{20, 20, 20}, {0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
    arc.closed = false;
    here.session.add_structures("Import", {set});
    here.session.wait_for_surfaces();
    const json surface = json::parse(here.session.greeting())["surfaces"][0];
    ASSERT_EQ(surface["sides"].size(), 1u) << surface;
    const json found = surface["sides"][0];
    EXPECT_TRUE(found["sure"]);
    const std::string inside = found["inside"], other = inside == "left" ? "right" : "left";
    const auto set_inside = [&](const std::string& side) {
        called(here.session, {{"call", "contour.set"}, {"id", found["contour"]}, {"inside", side}});
        here.session.wait_for_surfaces();
        return json::parse(here.session.greeting())["surfaces"][0];
    };
    EXPECT_FALSE(set_inside(other).contains("sides"));
    EXPECT_EQ(here.session.state().contours.at(found["contour"].get<Id>())->inside,
              other == "left" ? Hand::left : Hand::right);
    EXPECT_EQ(set_inside("auto")["sides"], surface["sides"]);
}

TEST(Session, WhatOnlyClosedOrOnlyOpenLinesCanBeIsRefusedInASentence) {
    SessionHere here;
    const Id structure = here.session.add_structures("Import", {circles(1, 20)}).front();
    const Id ring = here.session.state().contours.begin()->first;
    const json line = called(here.session, arc_to_add(structure))["result"]["contour"]["id"];
    const auto refusal = [&](json message) {
        message["call"] = "contour.set";
        return called(here.session, message)["error"]["message"].get<std::string>();
    };
    EXPECT_EQ(refusal({{"id", line}, {"hole", true}}), "an open line encloses nothing, so it can be no hole");
    EXPECT_EQ(refusal({{"id", ring}, {"inside", "left"}}),
              "the structure lies inside of a closed contour; of open lines alone the side is told");
    EXPECT_EQ(refusal({{"id", line}, {"inside", "up"}}), R"('inside' is "up"; left, right or auto is needed)");
}

TEST(Session, SeveralContoursAreChangedAsOneStep) {
    SessionHere here;
    const std::vector<Id> owners = here.session.add_structures("Import", {circles(3, 20), circles(1, 20)});
    json ids = json::array();
    for (const auto& [id, contour] : here.session.state().contours) ids.push_back(id);
    const auto count_of = [&](Id structure) {
        const State state = here.session.state();
        return std::ranges::count_if(state.contours, [&](const auto& one) { return one.second->structure == structure; });
    };
    const json move{{"call", "contour.set"}, {"ids", ids}, {"structure", owners[1]}};
    EXPECT_TRUE(called(here.session, move).contains("result"));
    EXPECT_EQ(count_of(owners[1]), 4);
    EXPECT_EQ(called(here.session, {{"call", "undo"}})["result"]["label"], "Change 4 contours");
    EXPECT_EQ(count_of(owners[1]), 1);
    EXPECT_TRUE(called(here.session, {{"call", "contour.set"}, {"ids", ids}, {"visible", false}}).contains("result"));
    for (const auto& [id, contour] : here.session.state().contours) EXPECT_FALSE(contour->visible);
    ids.push_back(1000);
    const json refused = called(here.session, {{"call", "contour.set"}, {"ids", ids}, {"visible", true}});
    EXPECT_EQ(refused["error"]["kind"], "invalid_input");
    for (const auto& [id, contour] : here.session.state().contours) EXPECT_FALSE(contour->visible);
}

TEST(Session, TheOutlineOnAPlaneThatNoViewShowsIsTold) {
    SessionHere here;
    const Id id = here.session.add_structures("Import", {circles(1, 60)}).front();
    here.session.wait_for_surfaces();
    json request{{"call", "outline"}, {"structure", id}, {"plane", circle_to_add(id, "drawn")["plane"]}};
    const json lines = called(here.session, request)["result"]["lines"];
    ASSERT_EQ(lines.size(), 1u);
    for (const json& p : lines[0]) {
        const Vec3 at{p[0], p[1], p[2]};
        EXPECT_NEAR(distance(at, test::kPlane.origin), 10, 0.5);
        EXPECT_NEAR(test::kPlane.distance_to(at), 0, 1e-6);
    }
    request["plane"]["origin"][2] = 1000;
    EXPECT_EQ(called(here.session, request)["result"]["lines"], json::array());
    request["structure"] = id + 1000;
    EXPECT_EQ(called(here.session, request)["result"]["lines"], json::array());
}

ContourSet three_circles() {
    ContourSet set = circles(1, 60);
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) {
        Contour contour{make_plane(test::kPlane.origin, normal), {}, true, false};
        for (int n = 0; n < 60; ++n)
            contour.points.push_back(
                contour.plane.from_uv(10 * std::cos(n * 0.1047197551), 10 * std::sin(n * 0.1047197551)));
        set.contours.push_back(contour);
    }
    return set;
}

TEST(Session, SaysHowSureTheSurfaceIsAndWhereToDrawNext) {
    SessionHere here;
    const Id ball = here.session.add_structures("Import", {three_circles()}).front();
    const Id flat = here.session.add_structures("Import", {circles(1, 60)}).front();
    here.session.wait_for_surfaces();
    const json surfaces = json::parse(here.session.greeting())["surfaces"];
    ASSERT_EQ(surfaces.size(), 2u);
    for (const json& surface : surfaces) {
        const json& told = surface["uncertainty"];
        EXPECT_EQ(told["known"], surface["structure"] == ball);
        EXPECT_EQ(told.contains("expected_dice"), surface["structure"] == ball);
        EXPECT_FALSE(told["text"].get<std::string>().empty());
    }

    json request{{"call", "suggest"}, {"structure", ball}};
    const json first = called(here.session, request)["result"]["planes"];
    ASSERT_EQ(first.size(), 1u);
    EXPECT_FALSE(first[0]["lines"].empty());
    request["skip"] = {first[0]["plane"]};
    const json second = called(here.session, request)["result"]["planes"];
    ASSERT_EQ(second.size(), 1u);
    EXPECT_NE(second[0]["plane"], first[0]["plane"]);
    request["slices"] = true;
    EXPECT_TRUE(called(here.session, request)["result"]["planes"][0].contains("slice"));
    request["skip"] = 7;
    EXPECT_EQ(called(here.session, request)["error"]["kind"], "invalid_input");

    // What is said to be empty is kept out of, until that is undone.
    const auto volume = [&] {
        here.session.wait_for_surfaces();
        const json told = json::parse(here.session.greeting())["surfaces"];
        for (const json& surface : told)
            if (surface["structure"] == ball) return surface["volume_ml"].get<double>();
        return 0.0;
    };
    const double before = volume();
    json empty = first[0]["plane"];
    for (int axis = 0; axis < 3; ++axis)
        empty["origin"][axis] = test::kPlane.origin[axis] + (axis == 0 ? 7.5 : axis == 1 ? 7.5 : 0);
    empty["normal"] = {std::sqrt(0.5), std::sqrt(0.5), 0};
    empty["u"] = {0, 0, 1};
    empty["v"] = {std::sqrt(0.5), -std::sqrt(0.5), 0};
    const json changed = called(here.session, {{"call", "structure.set"}, {"id", ball}, {"empty_planes", {empty}}});
    EXPECT_EQ(changed["result"]["structure"]["empty_planes"].size(), 1u);
    EXPECT_EQ(contour_set(here.session.state(), ball).empty_planes.size(), 1u);
    EXPECT_LE(volume(), before);
    EXPECT_TRUE(called(here.session, {{"call", "undo"}})["result"]["label"].get<std::string>().starts_with("Nothing of "));
    EXPECT_TRUE(contour_set(here.session.state(), ball).empty_planes.empty());
    EXPECT_EQ(volume(), before);

    const json across = called(here.session, {{"call", "suggest"}, {"structure", flat}})["result"]["planes"];
    ASSERT_EQ(across.size(), 1u);
    const json& normal = across[0]["plane"]["normal"];
    EXPECT_NEAR(dot({normal[0], normal[1], normal[2]}, test::kPlane.normal), 0, 1e-6);
    EXPECT_EQ(called(here.session, {{"call", "suggest"}, {"structure", flat + 1000}})["result"]["planes"], json::array());
}

}  // namespace
}  // namespace kontur::viewer
