// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/model/model_json.h"
#include "viewer/session/session.h"

// Single points that a structure's surface passes, or that lie inside or outside of it.

namespace kontur::viewer {
namespace {

using nlohmann::json;

/// Two great circles of a ball of 10 mm around (20, 20, 20).
ContourSet ball() {
    ContourSet set;
    set.name = "Ball";
    Contour upright{{test::kPlane.origin, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, true, false};
    for (const Vec3& p : test::circle(48)) upright.points.push_back({20, p.x, p.y});
    set.contours = {{test::kPlane, test::circle(48), true, false}, upright};
    return set;
}

const Vec3 kOut{30, 30, 30};  ///< 17 mm from the middle, far from what was drawn

struct Visit {
    kontur::test::TemporaryFolder folder;
    std::unique_ptr<Session> session = open();
    Id id = session->add_structures("Import", {ball()}).front();

    std::unique_ptr<Session> open() const {
        const OpenedImage image{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}};
        return std::make_unique<Session>(image, folder.path() / "a.kontur");
    }
    json call(json message) { return json::parse(session->call(message.dump())); }
    json point(const char* what, const Vec3& at) { return call({{"call", what}, {"structure", id}, {"at", to_json(at)}}); }
    std::vector<SurfacePoint> points() const { return structure_of(session->state(), id).surface_points; }

    /// How far the surface passes the point, in the plane across z.
    double off(const Vec3& at) {
        session->wait_for_surfaces();
        const Plane plane{at, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
        const json lines = call({{"call", "outline"}, {"structure", id}, {"plane", to_json(plane)}})["result"]["lines"];
        double nearest = 1e9;
        for (const json& line : lines)
            for (std::size_t i = 0; i < line.size(); ++i) {
                const auto vec = [&](std::size_t n) { return Vec3{line[n][0], line[n][1], line[n][2]}; };
                const Vec3 a = vec(i), b = vec((i + 1) % line.size());
                const double t = norm(b - a) == 0 ? 0 : std::clamp(dot(at - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
                nearest = std::min(nearest, distance(at, a + t * (b - a)));
            }
        return nearest;
    }
};

TEST(SurfacePoints, TheSurfacePassesAPointAndTheHistoryKnowsIt) {
    Visit visit;
    EXPECT_GT(visit.off(kOut), 3);
    EXPECT_EQ(visit.point("point.add", kOut)["result"]["structure"]["surface_points"],
              json::parse(R"([{"at": [30, 30, 30]}])"));
    EXPECT_LT(visit.off(kOut), 0.5);
    EXPECT_EQ(visit.call({{"call", "undo"}})["result"]["label"], "Point on Ball");
    EXPECT_GT(visit.off(kOut), 3);
    visit.call({{"call", "redo"}});
    EXPECT_LT(visit.off(kOut), 0.5);

    const Vec3 other{31, 31, 29};
    visit.call({{"call", "point.move"}, {"structure", visit.id}, {"at", to_json(kOut)}, {"to", to_json(other)}});
    EXPECT_LT(visit.off(other), 0.5);
    EXPECT_EQ(visit.point("point.remove", other)["result"]["structure"].count("surface_points"), 0u);
    EXPECT_GT(visit.off(other), 3);
    EXPECT_EQ(visit.call({{"call", "undo"}})["result"]["label"], "Remove a point on Ball");
    EXPECT_EQ(visit.call({{"call", "undo"}})["result"]["label"], "Move a point on Ball");
    EXPECT_EQ(visit.points(), std::vector<SurfacePoint>{{kOut}});
}

TEST(SurfacePoints, AreKeptAndExportedWithTheContours) {
    Visit visit;
    const Vec3 uneven{30.123456789012345, 28 + 1e-13, 31};
    visit.point("point.add", uneven);
    visit.session.reset();
    visit.session = visit.open();
    EXPECT_EQ(visit.points(), std::vector<SurfacePoint>{{uneven}});
    const json exported = json::parse(visit.session->exported("contours.json", visit.id).bytes);
    ASSERT_EQ(exported["surface"].size(), 1u);
    EXPECT_EQ(exported["surface"][0], to_json(uneven));
}

TEST(SurfacePoints, OfAFileComeInWithItsContours) {
    Visit visit;
    ContourSet set = ball();
    set.surface = {{kOut, normalized(Vec3{1, 1, 1})}};
    const Id id = visit.session->add_structures("Import", {set}).front();
    EXPECT_EQ(contour_set(visit.session->state(), id).surface, set.surface);
    visit.id = id;
    EXPECT_LT(visit.off(kOut), 0.5);
}

TEST(SinglePoints, InsideAndOutsideBendTheSurfaceAndComeInWithAFile) {
    Visit visit;
    ContourSet set = ball();
    set.interior = {{28, 28, 28}};  // 14 mm from the middle, where the ball is 10 mm wide
    visit.id = visit.session->add_structures("Import", {set}).front();
    const Vec3 edge{20 + 10 / std::sqrt(3.0), 20 + 10 / std::sqrt(3.0), 20 + 10 / std::sqrt(3.0)};
    EXPECT_EQ(contour_set(visit.session->state(), visit.id).interior, set.interior);
    EXPECT_GT(visit.off(edge), 2) << "the surface goes around the inner point";
    visit.session.reset();
    visit.session = visit.open();
    EXPECT_EQ(structure_of(visit.session->state(), visit.id).interior, set.interior) << "kept";
    EXPECT_EQ(json::parse(visit.session->exported("contours.json", visit.id).bytes)["interior"], to_json(set.interior));

    const auto turn = [&](const char* kind) {
        return visit.call({{"call", "point.set"}, {"structure", visit.id}, {"at", {28, 28, 28}}, {"kind", kind}});
    };
    const json turned = turn("exterior")["result"]["structure"];
    EXPECT_EQ(turned.count("interior"), 0u);
    EXPECT_EQ(turned["exterior"], json::parse("[[28, 28, 28]]"));
    EXPECT_LT(visit.off(edge), 1.5) << "outside it is anyway";
    EXPECT_EQ(turn("surface")["result"]["structure"]["surface_points"], json::parse(R"([{"at": [28, 28, 28]}])"));
    EXPECT_LT(visit.off({28, 28, 28}), 0.5);
    EXPECT_EQ(visit.call({{"call", "undo"}})["result"]["label"], "Point on Ball");
    EXPECT_EQ(visit.call({{"call", "undo"}})["result"]["label"], "Point outside of Ball");
    EXPECT_EQ(structure_of(visit.session->state(), visit.id).interior, set.interior);

    visit.call({{"call", "point.move"}, {"structure", visit.id}, {"at", {28, 28, 28}}, {"to", {29, 28, 28}}});
    EXPECT_EQ(structure_of(visit.session->state(), visit.id).interior, (std::vector<Vec3>{{29, 28, 28}}));
    EXPECT_EQ(visit.call({{"call", "undo"}})["result"]["label"], "Move a point inside of Ball");
    EXPECT_EQ(visit.point("point.add", {28, 28, 28})["error"]["message"], "Ball has a point there already");
    EXPECT_EQ(visit.point("point.remove", {28, 28, 28})["result"]["structure"].count("interior"), 0u);
}

TEST(SinglePoints, OfAFileAreNoMoreThanAProjectKeeps) {
    Visit visit;
    ContourSet set = ball();
    for (int i = 0; i < 1001; ++i) (i % 2 ? set.interior : set.exterior).push_back({0.01 * i, 5, 5});
    EXPECT_KONTUR_ERROR(visit.session->add_structures("Import", {set}), ErrorKind::too_large,
                        "Ball has 1001 single points; the limit is 1000");
}

TEST(SurfacePoints, WhatCannotBeDoneIsRefusedInOneSentence) {
    Visit visit;
    const auto refusal = [&](const char* what, const Vec3& at) { return visit.point(what, at)["error"]["message"]; };
    EXPECT_EQ(refusal("point.remove", kOut), "Ball has no point at 30, 30, 30");
    visit.point("point.add", kOut);
    EXPECT_EQ(refusal("point.add", kOut), "Ball has a point there already");
    EXPECT_EQ(refusal("point.add", {1e5, 0, 0}).get<std::string>().substr(0, 22), "surface point 2 lies 1");
    visit.id = visit.call({{"call", "structure.add"}, {"name", "New"}})["result"]["structure"]["id"];
    EXPECT_EQ(refusal("point.add", kOut), "New has no contour yet, and a point alone makes no surface");
}

}  // namespace
}  // namespace kontur::viewer
