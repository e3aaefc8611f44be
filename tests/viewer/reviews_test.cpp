// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/model/model_json.h"
#include "viewer/session/session.h"
#include "viewer/store/project.h"

// Structures locked, approved, commented.

namespace kontur::viewer {
namespace {

using nlohmann::json;

ContourSet disc(const std::string& name, double radius) {
    ContourSet set;
    set.name = name;
    set.contours = {{test::kPlane, test::circle(48, radius), true, false}};
    return set;
}

struct Visit {
    kontur::test::TemporaryFolder folder;
    std::vector<std::string> notices{};
    std::unique_ptr<Session> session = open();
    Id tumour = session->add_structures("Import", {disc("Tumour", 6)}).front();
    Id contour = session->state().contours.begin()->first;

    std::unique_ptr<Session> open() {
        const OpenedImage image{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}};
        auto opened = std::make_unique<Session>(image, folder.path() / "a.kontur");
        opened->on_event([this](const std::string& message) {
            const json event = json::parse(message);
            if (event["event"] == "notice") notices.push_back(event["text"]);
        });
        return opened;
    }
    json call(json message) { return json::parse(session->call(message.dump())); }
    json done(json message) {
        const json reply = call(std::move(message));
        EXPECT_TRUE(reply.contains("result")) << reply;
        return reply.value("result", json::object());
    }
    std::string refusal(json message) { return call(std::move(message)).value("/error/message"_json_pointer, ""); }
    Review review(Id id) const { return structure_of(session->state(), id).attributes.review; }
    json lock(Id id, bool locked = true) { return done({{"call", "structure.review"}, {"id", id}, {"locked", locked}}); }
    json approve(Id id, const std::string& by = "Doe") {
        return done({{"call", "structure.review"}, {"id", id}, {"approved_by", by}});
    }
    bool is_approved(Id id) const { return review(id).approved.has_value(); }
    Id rule(const std::string& line) { return done({{"call", "rule.set"}, {"line", line}})["structure"]["id"]; }
    json move(bool draft = false) const {
        return {{"call", "contour.translate"}, {"id", contour}, {"by", {1, 0, 0}}, {"draft", draft}};
    }
    json shift() { return done(move()); }
    json greeting(Id id) {
        const json greeting = json::parse(session->greeting());
        for (const json& one : greeting["structures"])
            if (one["id"] == id) return one;
        return nullptr;
    }
};

TEST(Reviews, NothingChangesALockedStructure) {
    Visit visit;
    const json changes[] = {
        visit.move(),
        visit.move(true),
        {{"call", "contour.remove"}, {"ids", {visit.contour}}},
        {{"call", "contour.set"}, {"id", visit.contour}, {"hole", true}},
        {{"call", "contour.set"}, {"ids", {visit.contour}}, {"weight", 2}},
        {{"call", "point.add"}, {"structure", visit.tumour}, {"at", {20, 20, 22}}, {"kind", "interior"}},
        {{"call", "structure.set"}, {"id", visit.tumour}, {"name", "Other"}},
        {{"call", "structure.set"}, {"id", visit.tumour}, {"smoothing", 0.1}},
        {{"call", "structure.set"}, {"id", visit.tumour}, {"empty_planes", {to_json(test::kPlane)}}},
        {{"call", "structure.remove"}, {"id", visit.tumour}},
    };
    visit.lock(visit.tumour);
    const auto contours = visit.session->state().contours;
    for (const json& change : changes)
        EXPECT_EQ(visit.refusal(change), "Tumour is locked, and stays as it is; unlock it in the list to change it")
            << change;
    EXPECT_EQ(visit.session->state().contours, contours);
    visit.lock(visit.tumour, false);
    for (const json& change : changes) {
        visit.done(change);
        if (!change.value("draft", false)) visit.done({{"call", "undo"}});
    }
}

TEST(Reviews, ALockedStructureMayLookOtherwiseAndTakesNoOthersLine) {
    Visit visit;
    const Id other = visit.session->add_structures("Import", {disc("Cord", 3)}).front();
    visit.lock(visit.tumour);
    visit.done({{"call", "structure.set"}, {"id", visit.tumour}, {"color", "#112233"}, {"visible", false}});
    visit.done({{"call", "contour.set"}, {"id", visit.contour}, {"visible", false}});
    visit.done({{"call", "structure.review"}, {"id", visit.tumour}, {"comment", "to the rim"}});
    EXPECT_EQ(visit.review(visit.tumour).comment, "to the rim");
    for (const auto& [id, contour] : visit.session->state().contours) {
        if (contour->structure != other) continue;
        EXPECT_NE(visit.refusal({{"call", "contour.set"}, {"id", id}, {"structure", visit.tumour}}), "");
    }
}

TEST(Reviews, TellWhoApprovedAndWhen) {
    Visit visit;
    visit.approve(visit.tumour, "Jane Doe");
    const auto approved = visit.review(visit.tumour).approved;
    ASSERT_TRUE(approved.has_value());
    EXPECT_EQ(approved->by, "Jane Doe");
    EXPECT_EQ(approved->at.size(), 19u) << approved->at;
    const json seen = visit.greeting(visit.tumour);
    EXPECT_EQ(seen["review"], (json{{"approved", {{"by", "Jane Doe"}, {"at", approved->at}}}}));
    EXPECT_FALSE(seen.contains("attributes"));
    visit.approve(visit.tumour, "");
    EXPECT_FALSE(visit.is_approved(visit.tumour));
    visit.done({{"call", "undo"}});
    EXPECT_EQ(visit.review(visit.tumour).approved, approved);
    EXPECT_TRUE(visit.notices.empty()) << visit.notices.front();
    const Id empty = visit.done({{"call", "structure.add"}, {"name", "Empty"}})["structure"]["id"];
    EXPECT_EQ(visit.refusal({{"call", "structure.review"}, {"id", empty}, {"approved_by", "Doe"}}),
              "Empty has 0 contours; at least 1 is needed to approve it");
    EXPECT_NE(visit.refusal({{"call", "structure.review"}, {"id", visit.tumour}, {"approved_by", "D\u202eoe"}}), "");
}

TEST(Reviews, AChangeTakesTheApprovalBackAndUndoRestoresIt) {
    Visit visit;
    const auto changed = [&](const json& change) {
        visit.notices.clear();
        visit.approve(visit.tumour);
        const auto approved = visit.review(visit.tumour).approved;
        visit.done(change);
        EXPECT_FALSE(visit.is_approved(visit.tumour)) << change;
        ASSERT_EQ(visit.notices.size(), 1u) << change;
        EXPECT_NE(visit.notices.front().find(" has changed, so the approval by Doe is taken back; undo restores both"),
                  std::string::npos)
            << visit.notices.front();
        visit.done({{"call", "undo"}});
        EXPECT_EQ(visit.review(visit.tumour).approved, approved) << change;
        visit.done({{"call", "redo"}});
        EXPECT_FALSE(visit.is_approved(visit.tumour)) << change;
        visit.done({{"call", "undo"}});
        visit.done({{"call", "undo"}});
    };
    changed(visit.move());
    changed({{"call", "structure.set"}, {"id", visit.tumour}, {"name", "GTV"}});
    changed({{"call", "structure.set"}, {"id", visit.tumour}, {"smoothing", 0.1}});
    changed({{"call", "borders.set"}, {"shared", false}});
    changed({{"call", "point.add"}, {"structure", visit.tumour}, {"at", {20, 20, 22}}, {"kind", "interior"}});

    visit.approve(visit.tumour);
    visit.done({{"call", "structure.set"}, {"id", visit.tumour}, {"color", "#112233"}, {"visible", false}});
    visit.done({{"call", "structure.set"}, {"id", visit.tumour}, {"label_value", 7}});
    visit.lock(visit.tumour);
    EXPECT_TRUE(visit.is_approved(visit.tumour)) << "it is the same body";
}

TEST(Reviews, WhatRulesMakeLosesItsApprovalWithItsSource) {
    Visit visit;
    const Id ptv = visit.rule("PTV = Tumour + 2 mm"), ring = visit.rule("Ring = PTV + 2 mm - PTV");
    const Id other = visit.session->add_structures("Import", {disc("Elsewhere", 3)}).front();
    visit.done({{"call", "borders.set"}, {"shared", false}});
    for (const Id id : {ptv, ring, other}) visit.approve(id);
    visit.lock(ring);
    visit.done({{"call", "structure.set"}, {"id", visit.tumour}, {"name", "GTV"}});
    EXPECT_TRUE(visit.is_approved(ptv)) << "another word for the same body";
    visit.shift();
    EXPECT_FALSE(visit.is_approved(ptv));
    EXPECT_FALSE(visit.is_approved(ring)) << "what follows others follows them though it is locked";
    EXPECT_TRUE(visit.is_approved(other));
    EXPECT_EQ(visit.notices.size(), 2u);
    EXPECT_NE(visit.refusal({{"call", "rule.set"}, {"line", "Ring = PTV + 3 mm - PTV"}}), "");
    EXPECT_NE(visit.refusal({{"call", "structure.freeze"}, {"id", ring}}), "");
}

TEST(Reviews, ANeighborAtASharedBorderLosesItsApproval) {
    Visit visit;
    const Id ring = visit.session->add_structures("Import", {disc("Around", 9)}).front();
    visit.done({{"call", "borders.rule"}, {"first", visit.tumour}, {"second", ring}, {"relation", "exclusive"}});
    visit.session->wait_for_surfaces();
    visit.approve(ring);
    visit.shift();
    EXPECT_FALSE(visit.is_approved(ring));
}

TEST(Reviews, ANeighborThatTouchesForTheFirstTimeTakesTheApprovalBack) {
    Visit visit;
    ContourSet far = disc("Far", 4);
    for (Vec3& p : far.contours.front().points) p.x += 14;
    const Id other = visit.session->add_structures("Import", {far}).front();
    visit.done({{"call", "borders.set"}, {"shared", true}});
    visit.session->wait_for_surfaces();
    visit.approve(visit.tumour);
    const auto moved = [&](double by) {
        for (const auto& [id, contour] : visit.session->state().contours)
            if (contour->structure == other)
                visit.done({{"call", "contour.translate"}, {"id", id}, {"by", {by, 0, 0}}, {"draft", false}});
        visit.session->wait_for_surfaces();
    };
    moved(1);
    EXPECT_TRUE(visit.is_approved(visit.tumour)) << "they do not touch";
    moved(-7);
    EXPECT_FALSE(visit.is_approved(visit.tumour));
    ASSERT_FALSE(visit.notices.empty());
    EXPECT_EQ(visit.notices.back(),
              "Tumour shares a border with Far now, which was edited, so the approval by Doe is taken back");
    visit.done({{"call", "undo"}});
    EXPECT_TRUE(visit.is_approved(visit.tumour)) << "a step of its own";
}

/// Half of a ball in the image's middle, on one side of x = 20.
std::shared_ptr<const StoredMask> half(bool is_left) {
    const std::shared_ptr<const Image> flat = test::flat_image();
    Mask mask{flat->grid, std::vector<std::uint8_t>(static_cast<std::size_t>(flat->grid.voxel_count()))};
    for (std::size_t n = 0; n < mask.values.size(); ++n) {
        const Index3 at = index_at(n, mask.grid.size);
        const Vec3 p = mask.grid.center_mm(at.i, at.j, at.k);
        mask.values[n] = norm(p - Vec3{20, 20, 20}) < 12 && (p.x < 19.5) == is_left;
    }
    return std::make_shared<const StoredMask>(mask);
}

TEST(Reviews, ALockedMaskStaysAsItIsWhateverItsNeighborBecomes) {
    Visit visit;
    const std::vector<Id> ids = visit.session->add_structures("Import", std::vector<ContourSet>(2),
                                                              ImportedMasks{{0, {half(true), ""}}, {1, {half(false), ""}}});
    const Id left = ids[0], right = ids[1];
    visit.done({{"call", "borders.set"}, {"shared", true}});
    const auto ml = [&](Id id) {
        visit.session->wait_for_surfaces();
        const json greeting = json::parse(visit.session->greeting());
        for (const json& one : greeting["surfaces"])
            if (one["structure"] == id) return one["volume_ml"].get<double>();
        return 0.0;
    };
    const double before = ml(right);
    visit.done({{"call", "point.add"}, {"structure", left}, {"at", {24, 20, 20}}, {"kind", "interior"}});
    const double followed = ml(right);
    EXPECT_LT(followed, before) << "the neighbour has taken some of it";
    visit.approve(right);
    visit.lock(right);
    EXPECT_DOUBLE_EQ(ml(right), followed);
    EXPECT_TRUE(visit.is_approved(right)) << "it is the same body";
    visit.done({{"call", "point.remove"}, {"structure", left}, {"at", {24, 20, 20}}});
    EXPECT_DOUBLE_EQ(ml(right), followed);
    EXPECT_TRUE(visit.is_approved(right)) << "it does not follow";
    visit.session.reset();
    visit.session = visit.open();
    EXPECT_DOUBLE_EQ(ml(right), followed) << "the project holds it";
    visit.lock(right, false);
    EXPECT_DOUBLE_EQ(ml(right), before) << "now it follows again";
    EXPECT_FALSE(visit.is_approved(right));
    visit.done({{"call", "undo"}});
    EXPECT_DOUBLE_EQ(ml(right), followed);
}

TEST(Reviews, AreInTheProjectWhichOlderVersionsRefuseThen) {
    Visit visit;
    const auto path = visit.folder.path() / "a.kontur";
    visit.approve(visit.tumour);
    visit.lock(visit.tumour);
    visit.done({{"call", "structure.review"}, {"id", visit.tumour}, {"comment", "to the rim"}});
    const Review review = visit.review(visit.tumour);
    visit.session.reset();
    {
        Project project(path, {});
        EXPECT_EQ(structure_of(project.state(), visit.tumour).attributes.review, review);
        EXPECT_EQ(project.database().number("PRAGMA user_version"), 5);
    }
    visit.session = visit.open();
    EXPECT_NE(visit.refusal(visit.move()), "");
    for (int step = 0; step < 3; ++step) visit.done({{"call", "undo"}});
    EXPECT_EQ(visit.review(visit.tumour), Review{});
    visit.shift();
}

}  // namespace
}  // namespace kontur::viewer
