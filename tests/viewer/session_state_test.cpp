// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/session_state.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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
    for (const auto calls : {border_calls, contour_calls, history_calls, page_calls, point_calls, proposal_calls,
                             second_image_calls, structure_calls, use_image_calls})
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
