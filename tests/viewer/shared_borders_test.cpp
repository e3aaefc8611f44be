// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "kontur/editor.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/model/model_json.h"
#include "viewer/session/session.h"
#include "viewer/surfaces/border_sharing.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr double kRadius = 12, kOff = 10;  // of balls on both sides of the plane x = 0

ContourSet ball(double x, double radius = kRadius) { return kontur::test::ball_slices({x, 0, 0}, radius, 2, 4); }

LoneSurface fitted(Id id, ContourSet set) {
    EditedSurface made = Editor().finish(set);
    return {id, std::make_shared<const ContourSet>(std::move(set)), made.function,
            std::make_shared<const TriangleMesh>(std::move(made.mesh))};
}

std::vector<LoneSurface> two_balls() { return {fitted(1, ball(-kOff)), fitted(2, ball(kOff))}; }

TEST(BorderSharing, TwoBallsPartAtThePlaneBetweenThem) {
    const std::vector<LoneSurface> alone = two_balls();
    BorderSharing sharing;
    const SharedBorders found = sharing.share(alone, {.shared = true});
    ASSERT_EQ(found.pairs.size(), 1u);
    EXPECT_EQ(found.pairs[0].relation, Relation::exclusive);
    EXPECT_FALSE(found.pairs[0].is_given);
    EXPECT_GT(found.pairs[0].share, 0.005);
    ASSERT_EQ(found.meshes.size(), 2u);
    const double cap = std::numbers::pi * (kRadius - kOff) * (kRadius - kOff) * (2 * kRadius + kOff) / 3;
    const double whole = 4.0 / 3 * std::numbers::pi * kRadius * kRadius * kRadius;
    for (const auto& [id, mesh] : found.meshes) {
        EXPECT_TRUE(topology(*mesh).closed);
        EXPECT_NEAR(signed_volume_mm3(*mesh), whole - cap, 0.01 * whole);
        EXPECT_EQ(mesh->normals.size(), mesh->points.size());
        double beyond = 0;
        for (const Vec3& p : mesh->points) beyond = std::max(beyond, id == 1 ? p.x : -p.x);
        EXPECT_LT(beyond, 0.4) << "a step of the lattice";
    }
    EXPECT_EQ(sharing.share(alone, {.shared = true}).meshes, found.meshes) << "nothing was made anew";
}

TEST(BorderSharing, RulesCountMoreThanWhatIsFound) {
    const std::vector<LoneSurface> alone = two_balls();
    const SharedBorders both = BorderSharing().share(alone, {true, {{2, 1, Relation::overlap}}});
    EXPECT_TRUE(both.meshes.empty());
    ASSERT_EQ(both.pairs.size(), 1u);
    EXPECT_TRUE(both.pairs[0].is_given);
    const std::vector<LoneSurface> nested{fitted(1, ball(0)), fitted(2, ball(2, 6))};
    const SharedBorders inside = BorderSharing().share(nested, {.shared = true});
    ASSERT_EQ(inside.pairs.size(), 1u);
    EXPECT_EQ(inside.pairs[0].relation, Relation::inside);
    EXPECT_EQ(inside.pairs[0].first, 2);
    EXPECT_TRUE(inside.meshes.empty()) << "both keep what they have";
    EXPECT_TRUE(BorderSharing().share({alone[0], fitted(3, ball(40))}, {.shared = true}).pairs.empty()) << "far apart";
}

TEST(Borders, AreTheSameAfterATripThroughJsonAndRefuseWhatTheyAreNot) {
    Borders borders{true, {{1, 2, Relation::inside}}};
    borders.set({2, 1, Relation::overlap});
    ASSERT_EQ(borders.rules.size(), 1u);
    EXPECT_EQ(borders_from_json(to_json(borders)), borders);
    EXPECT_KONTUR_ERROR(borders_from_json({{"shared", true}, {"rules", {{{"first", 1}, {"second", 2}, {"relation", "x"}}}}}),
                        ErrorKind::invalid_input, "'relation' is x; it must be exclusive, inside or overlap");
    const auto pairs = rules_among(borders, {7, 1, 2});
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].first, 2u);
    EXPECT_EQ(pairs[0].second, 1u);
    EXPECT_TRUE(rules_among(borders, {1, 7}).empty());
}

/// A session on a flat image with two structures, and what it tells.
struct SharingSession {
    explicit SharingSession(const std::vector<ContourSet>& sets) {
        for (const Id id : session.add_structures("Import", sets)) ids.push_back(id);
        session.wait_for_surfaces();
    }

    json call(json message) {
        message["seq"] = 1;
        return json::parse(session.call(message.dump()));
    }
    json told() { return json::parse(session.greeting()); }
    double volume_ml(std::size_t n) {
        session.wait_for_surfaces();
        const json event = told();
        for (const json& surface : event["surfaces"])
            if (surface["structure"] == ids[n] && surface["stage"] == "finished") return surface["volume_ml"];
        return 0;
    }

    kontur::test::TemporaryFolder folder;
    Session session{{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}}, folder.path() / "a.kontur"};
    std::vector<Id> ids;
};

ContourSet moved(ContourSet set) {
    for (Contour& contour : set.contours) {
        contour.plane.origin += Vec3{20, 20, 20};
        for (Vec3& p : contour.points) p += Vec3{20, 20, 20};
    }
    return set;
}

TEST(Session, NeighboursShareBordersByASwitchThatCanBeTakenBack) {
    SharingSession here({moved(ball(-kOff)), moved(ball(kOff))});
    const double cap = std::numbers::pi * (kRadius - kOff) * (kRadius - kOff) * (2 * kRadius + kOff) / 3000;
    const double together = here.volume_ml(0) + here.volume_ml(1);
    EXPECT_EQ(here.told()["borders"]["shared"], true);
    EXPECT_EQ(here.told()["border_pairs"][0]["relation"], "exclusive");
    here.call({{"call", "borders.set"}, {"shared", false}});
    EXPECT_NEAR(here.volume_ml(0) + here.volume_ml(1) - together, 2 * cap, 0.5 * cap);
    EXPECT_EQ(here.told()["border_pairs"], json::array());
    EXPECT_EQ(here.call({{"call", "undo"}})["result"]["label"], "Share no borders");
    EXPECT_DOUBLE_EQ(here.volume_ml(0) + here.volume_ml(1), together);
    const auto rule = [&](const json& relation) {
        return here.call(
            {{"call", "borders.rule"}, {"first", here.ids[0]}, {"second", here.ids[1]}, {"relation", relation}});
    };
    rule("overlap");
    EXPECT_GT(here.volume_ml(0) + here.volume_ml(1), together + cap);
    EXPECT_EQ(here.told()["borders"]["rules"][0]["relation"], "overlap");
    rule("auto");
    EXPECT_DOUBLE_EQ(here.volume_ml(0) + here.volume_ml(1), together);
    EXPECT_EQ(rule("beside")["error"]["kind"], "invalid_input");
    EXPECT_EQ(here.call({{"call", "borders.rule"}, {"first", 1}, {"second", 1}, {"relation", "inside"}})["error"]["kind"],
              "invalid_input");
}

/// Halves of a cylinder along z on both sides of x = `middle`; on the slice in the middle the border is at `there`, and only
/// the first one has drawn it.
std::vector<ContourSet> halves(double middle, double there) {
    std::vector<ContourSet> sets(2);
    for (int k = -3; k <= 3; ++k)
        for (std::size_t side = 0; side < 2; ++side) {
            if (k == 0 && side == 1) continue;
            const double x = k == 0 ? there : middle;
            const double from = side == 0 ? -14 : x + 0.05, to = side == 0 ? x - 0.05 : 14;
            Contour contour{{{0, 0, 3.0 * k}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, {}, true, false};
            const std::vector<Vec3> corners{{from, -8, 3.0 * k}, {to, -8, 3.0 * k}, {to, 8, 3.0 * k}, {from, 8, 3.0 * k}};
            for (std::size_t n = 0; n < 4; ++n)
                for (int step = 0; step < 16; ++step)
                    contour.points.push_back(corners[n] + (step / 16.0) * (corners[(n + 1) % 4] - corners[n]));
            sets[side].contours.push_back(contour);
        }
    return sets;
}

TEST(Session, ABorderThatOneAloneHasDrawnIsTheNeighboursToo) {
    std::vector<ContourSet> sets = halves(0, 2.5);
    SharingSession here({moved(sets[0]), moved(sets[1])});
    here.session.wait_for_surfaces();
    // Where the second one's surface cuts the slice on which it has drawn nothing.
    const Plane middle{{20, 20, 20}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    const auto border = [&] {
        here.session.wait_for_surfaces();
        const json lines =
            here.call({{"call", "outline"}, {"structure", here.ids[1]}, {"plane", to_json(middle)}})["result"]["lines"];
        double least = 1e9;
        for (const json& line : lines)
            for (const json& p : line)
                if (std::abs(p[1].get<double>() - 20) < 4) least = std::min(least, p[0].get<double>());
        return least - 20;
    };
    EXPECT_NEAR(border(), 2.5, 0.4);
    here.call({{"call", "borders.set"}, {"shared", false}});
    EXPECT_LT(border(), 1.2) << "by itself it does not know";
    here.call({{"call", "undo"}});
    EXPECT_NEAR(border(), 2.5, 0.4);
}

TEST(Session, BordersAreThoseOfTheLatestContoursHoweverFastTheyCome) {
    SharingSession here({moved(ball(-kOff)), moved(ball(kOff))});
    const double before = here.volume_ml(0);
    const Id contour = here.told()["contours"][2]["id"];
    for (int n = 0; n < 12; ++n) {
        here.call({{"call", "contour.translate"}, {"id", contour}, {"by", {n % 2 == 0 ? 1 : -1, 0, 0}}});
        std::this_thread::sleep_for(std::chrono::milliseconds(17 * n));
    }
    for (int n = 0; n < 12; ++n) here.call({{"call", "undo"}});
    EXPECT_DOUBLE_EQ(here.volume_ml(0), before);
    EXPECT_EQ(here.told()["surfaces"][1]["stage"], "finished");
}

TEST(Session, ANeighboursContourGoesAlongInTheSameStep) {
    const auto box = [](double left, double right) {
        ContourSet set;
        for (const double z : {12.0, 20.0, 28.0}) {
            Plane plane = test::kPlane;
            plane.origin.z = z;
            Contour contour{plane, {}, true, false};
            for (const auto& [u, v] : {std::pair{left, -10.}, {right, -10.}, {right, 10.}, {left, 10.}})
                contour.points.push_back(plane.from_uv(u, v));
            set.contours.push_back(contour);
        }
        return set;
    };
    SharingSession here({box(-12, -0.3), box(0.3, 12)});
    const json contours = here.told()["contours"];
    const json reply = here.call({{"call", "contour.pull"},
                                  {"id", contours[1]["id"]},
                                  {"from", {19.7, 20, 20}},
                                  {"to", {23, 20, 20}},
                                  {"radius_mm", 6}})["result"];
    ASSERT_EQ(reply["carried"].size(), 1u);
    EXPECT_EQ(reply["carried"][0]["id"], contours[4]["id"]);
    const auto leftmost = [&] {
        const State state = here.session.state();
        double least = 1e9;
        for (const Vec3& p : contour_of(state, contours[4]["id"]).points)
            if (std::abs(p.y - 20) < 1) least = std::min(least, p.x);
        return least;
    };
    EXPECT_NEAR(leftmost(), 23.6, 0.3);
    EXPECT_EQ(here.call({{"call", "undo"}})["result"]["label"], "Bend a contour");
    EXPECT_GT(leftmost(), 1e8) << "straight again, without points between";
    // By a rule that they may overlap, each is by itself.
    here.call({{"call", "borders.rule"}, {"first", here.ids[0]}, {"second", here.ids[1]}, {"relation", "overlap"}});
    EXPECT_EQ(here.call({{"call", "contour.translate"}, {"id", contours[1]["id"]}, {"by", {1, 0, 0}}})["result"]["carried"],
              json::array());
}

}  // namespace
}  // namespace kontur::viewer
