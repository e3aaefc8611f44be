// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/model/model_json.h"
#include "viewer/session/session.h"

// Structures that rules make of others.

namespace kontur::viewer {
namespace {

using nlohmann::json;

/// Two great circles of a ball around (20, 20, 20).
ContourSet ball(const std::string& name, double radius) {
    ContourSet set;
    set.name = name;
    Contour upright{{test::kPlane.origin, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, true, false};
    for (const Vec3& p : test::circle(48, radius)) upright.points.push_back({20, p.x, p.y});
    set.contours = {{test::kPlane, test::circle(48, radius), true, false}, upright};
    return set;
}

double ball_ml(double radius) { return 4 * std::numbers::pi / 3 * radius * radius * radius / 1000; }

struct Visit {
    kontur::test::TemporaryFolder folder;
    std::unique_ptr<Session> session = open();
    Id tumour = session->add_structures("Import", {ball("Tumour", 6)}).front();

    std::unique_ptr<Session> open() const {
        const OpenedImage image{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}};
        return std::make_unique<Session>(image, folder.path() / "a.kontur");
    }
    json call(json message) { return json::parse(session->call(message.dump())); }
    json done(json message) {
        const json reply = call(std::move(message));
        EXPECT_TRUE(reply.contains("result")) << reply;
        return reply.value("result", json::object());
    }
    std::string refusal(json message) { return call(std::move(message)).value("/error/message"_json_pointer, ""); }
    Id rule(const std::string& line) { return done({{"call", "rule.set"}, {"line", line}})["structure"]["id"]; }
    json check(const std::string& line) { return done({{"call", "rule.check"}, {"line", line}}); }
    json surface(Id id) {
        session->wait_for_surfaces();
        const json greeting = json::parse(session->greeting());
        for (const json& one : greeting["surfaces"])
            if (one["structure"] == id) return one;
        return nullptr;
    }
    Id add(const std::string& name, double radius) {
        return session->add_structures("Import", {ball(name, radius)}).front();
    }
    Structure known(Id id) const { return structure_of(session->state(), id); }
};

TEST(Rules, MakeASurfaceThatFollowsItsSource) {
    Visit visit;
    const Id ptv = visit.rule("PTV = Tumour + 5 mm");
    json made = visit.surface(ptv);
    EXPECT_EQ(made["stage"], "finished");
    EXPECT_NEAR(made["volume_ml"].get<double>() / ball_ml(11), 1, 0.04);
    EXPECT_EQ(visit.known(ptv).rule, "PTV = Tumour + 5 mm");

    const double before = made["volume_ml"];
    const Id contour = visit.session->state().contours.begin()->first;
    visit.done({{"call", "contour.translate"}, {"id", contour}, {"by", {3, 0, 0}}});
    EXPECT_NE(visit.surface(ptv)["volume_ml"], before) << "it follows what is drawn";
    visit.done({{"call", "undo"}});
    EXPECT_EQ(visit.surface(ptv)["volume_ml"], before);
    visit.done({{"call", "undo"}});
    EXPECT_FALSE(visit.session->state().structures.contains(ptv));
    visit.done({{"call", "redo"}});
    EXPECT_EQ(visit.surface(ptv)["volume_ml"], before);
}

TEST(Rules, ADraftMovesThemBeforeItIsAStep) {
    Visit visit;
    const Id ptv = visit.rule("PTV = Tumour + 5 mm");
    const double before = visit.surface(ptv)["volume_ml"];
    const Id contour = visit.session->state().contours.begin()->first;
    visit.done({{"call", "contour.translate"}, {"id", contour}, {"by", {3, 0, 0}}, {"draft", true}});
    EXPECT_NE(visit.surface(ptv)["volume_ml"], before);
    visit.done({{"call", "draft.drop"}});
    EXPECT_EQ(visit.surface(ptv)["volume_ml"], before);
}

TEST(Rules, ErrorsHaveTheirPlaceInTheLine) {
    Visit visit;
    visit.add("Tum\u00f6r", 4);
    EXPECT_EQ(visit.check("PTV = Tumour + 5 mm"), (json{{"name", "PTV"}, {"is_new", true}}));
    const json unknown = visit.check("PTV = Tumor + 5 mm")["problem"];
    EXPECT_EQ(unknown["at"], 6);
    EXPECT_NE(unknown["text"].get<std::string>().find("there is no structure 'Tumor'"), std::string::npos);
    EXPECT_EQ(visit.check("PTV = Tum\u00f6r + 5 m")["problem"]["at"], 16) << "characters, not bytes";
    EXPECT_EQ(visit.check("Tumour = Tumour + 5 mm")["problem"]["at"], 0);
    visit.rule("PTV = Tumour + 5 mm");
    EXPECT_EQ(visit.check("PTV = Tumour + 6 mm"), (json{{"name", "PTV"}, {"is_new", false}}));
    visit.add("Tumour", 5);
    EXPECT_NE(
        visit.check("Ring = Tumour + 5 mm")["problem"]["text"].get<std::string>().find("2 structures are named Tumour"),
        std::string::npos);
}

TEST(Rules, CirclesAreRefusedWithTheirMembers) {
    Visit visit;
    visit.rule("A = Tumour + 2 mm");
    visit.rule("B = A + 2 mm");
    const std::string refusal = visit.refusal({{"call", "rule.set"}, {"line", "A = B - 1 mm"}});
    EXPECT_NE(refusal.find("rules run in a circle: A needs B needs A"), std::string::npos) << refusal;
}

TEST(Rules, AUsedStructureStays) {
    Visit visit;
    const Id a = visit.rule("A = Tumour + 2 mm");
    EXPECT_EQ(visit.refusal({{"call", "structure.remove"}, {"id", visit.tumour}}),
              "Tumour is used by the rule A = Tumour + 2 mm; freeze or delete A first");
    visit.done({{"call", "structure.remove"}, {"id", a}});
    visit.done({{"call", "structure.remove"}, {"id", visit.tumour}});
}

TEST(Rules, ANewNameChangesAllThatUseIt) {
    Visit visit;
    std::vector<Id> rules;
    for (const std::string name : {"A", "B", "C", "D"}) rules.push_back(visit.rule(name + " = Tumour + 2 mm"));
    visit.done({{"call", "structure.set"}, {"id", visit.tumour}, {"name", "Gross tumour volume of the left side"}});
    for (const Id id : rules)
        EXPECT_EQ(visit.known(id).rule, visit.known(id).name + " = 'Gross tumour volume of the left side' + 2 mm");
}

TEST(Rules, ANewNameChangesThem) {
    Visit visit;
    const Id a = visit.rule("A = Tumour + 2 mm"), b = visit.rule("B = A + 2 mm");
    visit.done({{"call", "structure.set"}, {"id", visit.tumour}, {"name", "GTV left"}});
    EXPECT_EQ(visit.known(a).rule, "A = 'GTV left' + 2 mm");
    visit.done({{"call", "structure.set"}, {"id", a}, {"name", "CTV"}});
    EXPECT_EQ(visit.known(a).rule, "CTV = 'GTV left' + 2 mm");
    EXPECT_EQ(visit.known(b).rule, "B = CTV + 2 mm");
    EXPECT_NEAR(visit.surface(b)["volume_ml"].get<double>() / ball_ml(10), 1, 0.04);
    EXPECT_NE(visit.refusal({{"call", "structure.add"}, {"name", "CTV"}}).find("CTV is a name in the rule"),
              std::string::npos);
    const Id other = visit.add("Cord", 3);
    EXPECT_NE(visit.refusal({{"call", "structure.set"}, {"id", other}, {"name", "GTV left"}}), "");
    visit.done({{"call", "undo"}});
    visit.done({{"call", "undo"}});
    EXPECT_EQ(visit.known(b).rule, "B = A + 2 mm");
}

TEST(Rules, NothingIsDrawnInWhatTheyMake) {
    Visit visit;
    const Id ptv = visit.rule("PTV = Tumour + 5 mm");
    const std::string why = "PTV is made by the rule PTV = Tumour + 5 mm; change the rule, or freeze PTV to draw in it";
    const Id contour = visit.session->state().contours.begin()->first;
    EXPECT_EQ(visit.refusal({{"call", "contour.set"}, {"id", contour}, {"structure", ptv}}), why);
    EXPECT_EQ(visit.refusal({{"call", "contour.set"}, {"ids", {contour}}, {"structure", ptv}}), why);
    EXPECT_EQ(visit.refusal({{"call", "point.add"}, {"structure", ptv}, {"at", {20, 20, 20}}, {"kind", "interior"}}), why);
    EXPECT_EQ(visit.refusal({{"call", "structure.set"}, {"id", ptv}, {"smoothing", 0.1}}), why);
    visit.done({{"call", "structure.set"}, {"id", ptv}, {"color", "#112233"}});
}

TEST(Rules, FrozenItIsAMaskThatFollowsNothing) {
    Visit visit;
    const Id ptv = visit.rule("PTV = Tumour + 5 mm");
    const double before = visit.surface(ptv)["volume_ml"];
    visit.done({{"call", "structure.freeze"}, {"id", ptv}});
    const Structure frozen = visit.known(ptv);
    EXPECT_FALSE(frozen.rule.has_value());
    ASSERT_TRUE(frozen.mask.has_value());
    EXPECT_EQ(frozen.attributes.description, "derived: PTV = Tumour + 5 mm");
    visit.done({{"call", "structure.remove"}, {"id", visit.tumour}});
    EXPECT_NEAR(visit.surface(ptv)["volume_ml"].get<double>() / before, 1, 0.02);
    visit.done({{"call", "undo"}});
    visit.done({{"call", "undo"}});
    EXPECT_EQ(visit.known(ptv).rule, "PTV = Tumour + 5 mm");
    EXPECT_EQ(visit.surface(ptv)["volume_ml"], before);
    EXPECT_EQ(visit.refusal({{"call", "structure.freeze"}, {"id", visit.tumour}}),
              "Tumour is made by no rule, so nothing moves it");
}

TEST(Rules, APreviewSaysHowMuchItWouldBe) {
    Visit visit;
    visit.session->wait_for_surfaces();
    const json seen =
        visit.done({{"call", "rule.preview"}, {"line", "PTV = Tumour + 5 mm"}, {"planes", {to_json(test::kPlane)}}});
    EXPECT_NEAR(seen["volume_ml"].get<double>() / ball_ml(11), 1, 0.04);
    ASSERT_EQ(seen["lines"].size(), 1u);
    ASSERT_EQ(seen["lines"][0].size(), 1u);
    for (const json& p : seen["lines"][0][0])
        EXPECT_NEAR(std::hypot(p[0].get<double>() - 20, p[1].get<double>() - 20), 11, 0.4);
    EXPECT_EQ(visit.session->state().structures.size(), 1u) << "nothing is made by it";
    visit.done({{"call", "structure.add"}, {"name", "Empty"}});
    EXPECT_EQ(visit.refusal({{"call", "rule.preview"}, {"line", "X = Empty + 5 mm"}}), "There is no surface of Empty yet.");
}

TEST(Rules, TheProjectKeepsThem) {
    Visit visit;
    const Id ptv = visit.rule("PTV = Tumour + 5 mm - (Tumour + 1 mm)");
    const double before = visit.surface(ptv)["volume_ml"];
    visit.session.reset();
    visit.session = visit.open();
    EXPECT_EQ(visit.known(ptv).rule, "PTV = Tumour + 5 mm - (Tumour + 1 mm)");
    EXPECT_EQ(visit.surface(ptv)["volume_ml"], before);
}

TEST(Rules, AFormerlyEmptyStructureOfTheNameTakesTheRule) {
    Visit visit;
    const Id empty = visit.done({{"call", "structure.add"}, {"name", "PTV"}})["structure"]["id"];
    EXPECT_EQ(visit.rule("PTV = Tumour + 5 mm"), empty);
    EXPECT_EQ(visit.done({{"call", "undo"}})["label"], "Add PTV");
    EXPECT_FALSE(visit.known(empty).rule.has_value());
}

TEST(Rules, OneThatCannotBeFollowedSaysWhy) {
    Visit visit;
    const Id cord = visit.done({{"call", "structure.add"}, {"name", "Cord"}})["structure"]["id"];
    const Id a = visit.rule("A = Tumour - (Cord + 3 mm)"), b = visit.rule("B = Tumour + 2 mm");
    EXPECT_EQ(visit.surface(a)["warnings"], json({"There is no surface of Cord yet."}));
    EXPECT_EQ(visit.surface(b)["stage"], "finished");
    const Id c = visit.rule("C = B - B");
    EXPECT_EQ(visit.surface(c)["warnings"], json({"The rule leaves nothing."}));
    EXPECT_EQ(visit.surface(cord).value("stage", "none"), "none");
}

}  // namespace
}  // namespace kontur::viewer
