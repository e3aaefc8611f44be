// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/session_state.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/model/message_checks.h"
#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"

// What calls work on, without a session that speaks the protocol.

namespace kontur::viewer {
namespace {

using nlohmann::json;

TEST(Calls, EachCallOfTheProtocolIsInTheTableOfOneFile) {
    std::size_t count = 0;
    for (const auto calls : {border_calls, contour_calls, history_calls, motion_calls, page_calls, point_calls,
                             proposal_calls, review_calls, rule_calls, second_image_calls, structure_calls, use_image_calls})
        for (const auto& [name, call] : calls()) {
            EXPECT_TRUE(call_types().contains(name)) << name;
            EXPECT_NE(call.carry_out, nullptr) << name;
            ++count;
        }
    EXPECT_EQ(count, call_types().size());
    EXPECT_EQ(all_calls().size(), call_types().size());
}

TEST(Calls, ACallWorksOnTheStateAloneAndTellsPages) {
    const kontur::test::TemporaryFolder folder;
    SessionState state({test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}},
                       folder.path() / "a.kontur");
    std::vector<json> events;
    state.pages.on_event([&](const std::string& message) { events.push_back(json::parse(message)); });
    const json arguments{{"name", "Liver"}};
    const json reply = structure_calls().at("structure.add").carry_out(state, Members(arguments));
    EXPECT_EQ(reply["structure"]["name"], "Liver");
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events.front()["event"], "changed");
    EXPECT_EQ(events.front()["history"]["undo"], "Add Liver");
    const json none = json::object();
    EXPECT_EQ(history_calls().at("undo").carry_out(state, Members(none))["label"], "Add Liver");
    EXPECT_TRUE(state.state().structures.empty());
    state.surfaces.wait();
    state.pages.on_event({});
}

/// The argument of a call without a session around it.
struct Visit {
    kontur::test::TemporaryFolder folder;
    SessionState state{{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}},
                       folder.path() / "a.kontur"};

    json call(const std::string& name, const json& arguments) {
        return all_calls().at(name).carry_out(state, Members(arguments));
    }
    std::string undo_label() { return *state.project.undo_label(); }
};

TEST(Structures, TwentyFourHaveColoursOfTheirOwn) {
    Visit visit;
    std::set<std::string> colors;
    for (int n = 0; n < 24; ++n)
        colors.insert(visit.call("structure.add", json::object())["structure"]["color"].get<std::string>());
    EXPECT_EQ(colors.size(), 24u);
}

TEST(Structures, OneAloneIsShownAndAllAgainInOneStepEach) {
    Visit visit;
    std::vector<Id> ids;
    for (const char* name : {"Liver", "Spleen", "Kidney"})
        ids.push_back(visit.call("structure.add", {{"name", name}})["structure"]["id"].get<Id>());
    const auto shown = [&] {
        std::vector<Id> seen;
        for (const auto& [id, structure] : visit.state.state().structures)
            if (structure.visible) seen.push_back(id);
        return seen;
    };
    visit.call("structure.show_only", {{"id", ids[1]}});
    EXPECT_EQ(shown(), std::vector<Id>{ids[1]});
    EXPECT_EQ(visit.undo_label(), "Show only Spleen");
    visit.call("structure.show_only", {{"id", ids[1]}});
    EXPECT_EQ(shown(), ids);
    EXPECT_EQ(visit.undo_label(), "Show all structures");
    visit.call("undo", json::object());
    visit.call("undo", json::object());
    EXPECT_EQ(shown(), ids);
}

TEST(Structures, NamesThatWouldDeceiveAreRefusedAndChangeNothing) {
    Visit visit;
    const Id id = visit.call("structure.add", {{"name", "Liver"}})["structure"]["id"].get<Id>();
    EXPECT_THROW(visit.call("structure.set", {{"id", id}, {"name", "Li\u202ever"}}), Error);
    EXPECT_THROW(visit.call("structure.add", {{"name", "a\nb"}}), Error);
    EXPECT_EQ(visit.state.state().structures.size(), 1u);
    EXPECT_EQ(visit.state.state().structures.begin()->second.name, "Liver");
}

TEST(Structures, ALabelValueBelongsToOneOfThemAndIsAStepOfTheHistory) {
    Visit visit;
    const Id liver = visit.call("structure.add", {{"name", "Liver"}})["structure"]["id"].get<Id>();
    const Id spleen = visit.call("structure.add", {{"name", "Spleen"}})["structure"]["id"].get<Id>();
    EXPECT_EQ(visit.call("structure.set", {{"id", liver}, {"label_value", 26}})["structure"]["label_value"], 26);
    EXPECT_EQ(visit.undo_label(), "Label value of Liver");
    try {
        visit.call("structure.set", {{"id", spleen}, {"label_value", 26}});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()), "Liver has the label value 26 already; give it another one first");
    }
    for (const json& wrong : {json(0), json(65536), json(1.5), json("many")})
        EXPECT_THROW(visit.call("structure.set", {{"id", spleen}, {"label_value", wrong}}), Error) << wrong;
    visit.call("structure.set", {{"id", liver}, {"label_value", "automatic"}});
    EXPECT_FALSE(visit.state.state().structures.at(liver).label_value);
    visit.call("undo", json::object());
    EXPECT_EQ(visit.state.state().structures.at(liver).label_value, 26);
}

TEST(WatchedPlanes, AViewHasOnePlaneAndTheOldestOfNineIsForgotten) {
    WatchedPlanes watched;
    watched.set({"one", "axial", {}, 1});
    watched.set({"one", "axial", {}, 2});
    ASSERT_EQ(watched.all().size(), 1u);
    EXPECT_EQ(watched.all().front().plane, 2);
    for (int n = 0; n < 8; ++n) watched.set({"page " + std::to_string(n), "axial", {}, n});
    ASSERT_EQ(watched.all().size(), 8u);
    EXPECT_EQ(watched.all().front().page, "page 0");
}

}  // namespace
}  // namespace kontur::viewer
