// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "kontur/io/image.h"
#include "kontur/segment.h"
#include "kontur/segment_together.h"
#include "support/lobed_body.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/model/model_json.h"
#include "viewer/session/session.h"

// Surfaces and exports that the image helps to make.

namespace kontur::viewer {
namespace {

using nlohmann::json;

std::shared_ptr<const Image> image_of_body() {
    static const auto image =
        std::make_shared<const Image>(kontur::test::image_of(kontur::test::cube_grid(2.5), kontur::test::body_look, 8));
    return image;
}

std::shared_ptr<const Image> image_of_noise() {
    const auto nothing = [](const Vec3&) { return 50.0; };
    return std::make_shared<const Image>(kontur::test::image_of(kontur::test::cube_grid(3), nothing, 20));
}

std::shared_ptr<const Image> label_map() {
    const auto inside = [](const Vec3& p) { return kontur::test::lobed_depth(p) > 0 ? 1.0 : 0.0; };
    return std::make_shared<const Image>(kontur::test::image_of(kontur::test::cube_grid(3), inside));
}

ContourSet drawing() {
    ContourSet set = kontur::test::drawn_on(kontur::test::orthogonal_planes());
    set.name = "Body";
    return set;
}

/// A session with one structure, and all that it tells.
class Visit {
public:
    explicit Visit(std::shared_ptr<const Image> on_image, const ContourSet& set = drawing())
        : image(std::move(on_image)),
          session({image, "body", {"/images/body.nii", "body"}, {}}, folder.path() / "a.kontur") {
        session.on_event([this](const std::string& message) {
            const std::scoped_lock lock(mutex_);
            events_.push_back(json::parse(message));
        });
        structure = session.add_structures("Import", {set}).front();
        session.wait_for_surfaces();
    }
    ~Visit() { session.on_event({}); }

    json call(json message) {
        message["seq"] = 1;
        json reply = json::parse(session.call(message.dump()));
        session.wait_for_surfaces();
        return reply;
    }
    json greeting() { return json::parse(session.greeting()); }
    json surface() { return greeting()["surfaces"][0]; }

    /// All surfaces told since the last time.
    std::vector<json> told_surfaces() {
        const std::scoped_lock lock(mutex_);
        std::vector<json> surfaces;
        for (const json& event : events_)
            if (event["event"] == "surface") surfaces.push_back(event);
        events_.clear();
        return surfaces;
    }

    std::vector<std::uint8_t> exported_mask() {
        const Download file = session.exported("mask.nrrd", structure);
        const auto path = folder.path() / "mask.nrrd";
        std::ofstream(path, std::ios::binary) << file.bytes;
        return read_mask(path).values;
    }
    Segmentation segmented(bool with_image) {
        return segment(contour_set(session.state(), structure), image->grid, with_image ? image.get() : nullptr);
    }

    /// The JSON of a slice through the origin across z.
    json slice() {
        const json request{
            {"view", "axial"},
            {"plane",
             {{"origin", {-40, -40, 14}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}, {"mm_per_pixel", 1}}},
            {"width", 80},
            {"height", 80},
            {"pixels", false}};
        const std::string bytes = session.slice(request.dump());
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data(), sizeof length);
        return json::parse(bytes.substr(sizeof length, length));
    }

    kontur::test::TemporaryFolder folder;
    std::shared_ptr<const Image> image;
    Session session;
    Id structure = 0;

private:
    std::mutex mutex_;
    std::vector<json> events_;
};

std::vector<std::string> stages(const std::vector<json>& surfaces) {
    std::vector<std::string> names;
    for (const json& surface : surfaces) names.push_back(surface["stage"]);
    return names;
}

double volume_ml(const Segmentation& made) {
    const auto voxels = std::count(made.mask.values.begin(), made.mask.values.end(), std::uint8_t{1});
    return static_cast<double>(voxels) * made.mask.grid.voxel_volume_mm3() / 1000;
}

TEST(SessionImage, HelpsToMakeSurfaceAndExportsAsItDoesForSegment) {
    Visit here(image_of_body());
    const std::vector<json> told = here.told_surfaces();
    ASSERT_EQ(stages(told), (std::vector<std::string>{"preview", "asking", "finished"}));
    EXPECT_FALSE(told[1].contains("image"));
    EXPECT_NE(told[1]["volume_ml"], told[2]["volume_ml"]);
    const Segmentation with = here.segmented(true), without = here.segmented(false);
    EXPECT_EQ(told[2]["image"]["verdict"], "used");
    EXPECT_EQ(told[2]["image"]["text"], sentence(with.report.image));
    EXPECT_NE(with.mask.values, without.mask.values);
    EXPECT_EQ(here.exported_mask(), with.mask.values);
    // What the image adds to how sure the surface is counts, too.
    const double expected = told[2]["uncertainty"]["expected_dice"]["value"],
                 before = told[1]["uncertainty"]["expected_dice"]["value"];
    EXPECT_GT(expected, before);
    EXPECT_NEAR(expected, with.report.uncertainty.dice.value, 0.01);
}

TEST(SessionImage, IsUsedByASwitchThatCanBeTakenBack) {
    Visit here(image_of_body());
    EXPECT_EQ(here.greeting()["use_image"], true);
    const double with_ml = here.surface()["volume_ml"];
    EXPECT_TRUE(here.slice()["outlines"][0].contains("without_image"));
    EXPECT_TRUE(here.call({{"call", "image.set"}, {"use", false}}).contains("result"));
    EXPECT_EQ(here.greeting()["use_image"], false);
    EXPECT_EQ(here.surface()["stage"], "finished");
    EXPECT_FALSE(here.surface().contains("image"));
    EXPECT_NE(here.surface()["volume_ml"], with_ml);
    EXPECT_FALSE(here.slice()["outlines"][0].contains("without_image"));
    EXPECT_EQ(here.exported_mask(), here.segmented(false).mask.values);
    EXPECT_EQ(here.call({{"call", "undo"}})["result"]["label"], "Do not use the image");
    EXPECT_EQ(here.surface()["volume_ml"], with_ml);
    EXPECT_EQ(here.exported_mask(), here.segmented(true).mask.values);
    EXPECT_EQ(here.call({{"call", "redo"}})["result"]["label"], "Do not use the image");
    EXPECT_FALSE(here.surface().contains("image"));
    EXPECT_EQ(here.call({{"call", "image.set"}, {"use", 1}})["error"]["kind"], "invalid_input");
}

TEST(SessionImage, WhereItDoesNotHelpTheSurfaceStaysAndKeepsItsRevision) {
    Visit here(image_of_noise());
    const std::vector<json> told = here.told_surfaces();
    ASSERT_EQ(stages(told), (std::vector<std::string>{"preview", "asking", "finished"}));
    EXPECT_EQ(told[2]["revision"], told[1]["revision"]);
    EXPECT_EQ(told[2]["volume_ml"], told[1]["volume_ml"]);
    EXPECT_EQ(told[2]["image"]["verdict"], "no_help");
    EXPECT_FALSE(here.slice()["outlines"][0].contains("without_image"));
    EXPECT_EQ(here.exported_mask(), here.segmented(false).mask.values);
}

TEST(SessionImage, UntilItHasAnsweredAgainWhatIsShownFollowsWhatItSaidBefore) {
    for (const auto& image : {image_of_body(), image_of_noise()}) {
        Visit here(image);
        here.told_surfaces();
        const Id contour = here.greeting()["contours"][0]["id"];
        here.call({{"call", "contour.translate"}, {"id", contour}, {"by", {0.5, 0, 0}}});
        const std::vector<json> told = here.told_surfaces();
        ASSERT_EQ(stages(told), (std::vector<std::string>{"outdated", "preview", "asking", "finished"}));
        const Segmentation made = here.segmented(true);
        const bool is_used = made.report.image.verdict == ImageVerdict::used;
        EXPECT_EQ(told[2]["revision"] == told[3]["revision"], !is_used);
        const double followed_ml = told[2]["volume_ml"], made_ml = told[3]["volume_ml"],
                     alone_ml = volume_ml(here.segmented(false));
        if (is_used) {
            EXPECT_LT(std::abs(followed_ml - made_ml), 0.5 * std::abs(alone_ml - made_ml));
        }
        EXPECT_EQ(told.back()["image"]["text"], sentence(made.report.image));
        EXPECT_EQ(told.back()["revision"], here.surface()["revision"]);
        EXPECT_GT(told.back()["revision"], told[1]["revision"]);
        EXPECT_EQ(here.exported_mask(), made.mask.values);
        EXPECT_EQ(here.slice()["outlines"][0].contains("without_image"), is_used);
    }
}

TEST(SessionImage, WhatThePreviewFollowedIsTakenBackWhereTheImageIsNotUsedAnyMore) {
    Visit here(image_of_body());
    here.told_surfaces();
    // Of two planes nobody can tell whether the image helps.
    const json contours = here.greeting()["contours"];
    here.call({{"call", "contour.remove"}, {"ids", {contours[0]["id"], contours[1]["id"]}}});
    const std::vector<json> told = here.told_surfaces();
    ASSERT_EQ(stages(told), (std::vector<std::string>{"outdated", "preview", "asking", "finished"}));
    EXPECT_EQ(told.back()["image"]["verdict"], "unknown");
    EXPECT_GT(told.back()["revision"], told[1]["revision"]);
    EXPECT_EQ(here.exported_mask(), here.segmented(false).mask.values);
    EXPECT_FALSE(here.slice()["outlines"][0].contains("without_image"));
}

TEST(SessionImage, IsNotAskedWhereItCannotTellBorders) {
    for (const auto& image : {label_map(), test::flat_image()}) {
        Visit here(image);
        EXPECT_EQ(here.greeting()["use_image"], nullptr);
        EXPECT_EQ(stages(here.told_surfaces()), (std::vector<std::string>{"preview", "finished"}));
        EXPECT_FALSE(here.surface().contains("image"));
    }
}

TEST(SessionImage, IsAskedOfEachStructureOnceTheSwitchIsOn) {
    Visit here(image_of_body());
    const Id other = here.session.add_structures("Import", {drawing()}).front();
    here.session.wait_for_surfaces();
    here.call({{"call", "image.set"}, {"use", false}});
    here.told_surfaces();
    here.call({{"call", "undo"}});
    std::map<Id, json> last;
    for (const json& surface : here.told_surfaces()) last[surface["structure"]] = surface;
    for (const Id id : {here.structure, other}) {
        EXPECT_EQ(last[id]["stage"], "finished");
        EXPECT_EQ(last[id]["image"]["verdict"], "used");
    }
}

TEST(SessionImage, TheLatestOfManySwitchesCounts) {
    Visit here(image_of_body());
    const json first = here.surface();
    for (int n = 0; n < 6; ++n) here.session.call(json{{"seq", n}, {"call", "image.set"}, {"use", n % 2 == 1}}.dump());
    here.session.wait_for_surfaces();
    EXPECT_EQ(here.surface()["volume_ml"], first["volume_ml"]);
    EXPECT_EQ(here.surface()["image"], first["image"]);
}

TEST(SessionSmoothing, OfAStructureIsAStepAndMakesSurfaceAndExportsAsSegmentDoes) {
    Visit here(label_map());
    const json usual = here.surface();
    const auto smooth = [&](const json& smoothing) {
        return here.call({{"call", "structure.set"}, {"id", here.structure}, {"smoothing", smoothing}});
    };
    const auto segmented = [&](std::optional<double> smoothing) {
        SegmentOptions options;
        options.smoothing = smoothing;
        return segment(contour_set(here.session.state(), here.structure), here.image->grid, options).mask.values;
    };
    EXPECT_FALSE(here.greeting()["structures"][0].contains("smoothing"));
    here.told_surfaces();
    EXPECT_TRUE(smooth(1e-2).contains("result"));
    EXPECT_EQ(stages(here.told_surfaces()), (std::vector<std::string>{"outdated", "preview", "finished"}));
    EXPECT_EQ(here.greeting()["structures"][0]["smoothing"], 1e-2);
    EXPECT_GT(here.surface()["residual"]["rms_mm"], usual["residual"]["rms_mm"]);
    EXPECT_NE(segmented(1e-2), segmented({}));
    EXPECT_EQ(here.exported_mask(), segmented(1e-2));
    const Structure stored = here.session.state().structures.at(here.structure);
    EXPECT_EQ(structure_from_json(to_json(stored)), stored);

    EXPECT_TRUE(smooth(0).contains("result"));
    EXPECT_EQ(here.exported_mask(), segmented(0));
    EXPECT_EQ(here.call({{"call", "undo"}})["result"]["label"], "Smoothing of Body");
    EXPECT_EQ(here.call({{"call", "undo"}})["result"]["label"], "Smoothing of Body");
    EXPECT_EQ(here.surface()["volume_ml"], usual["volume_ml"]);
    EXPECT_EQ(here.exported_mask(), segmented({}));
    here.call({{"call", "redo"}});
    EXPECT_EQ(here.exported_mask(), segmented(1e-2));
    EXPECT_TRUE(smooth("usual").contains("result"));
    EXPECT_FALSE(here.greeting()["structures"][0].contains("smoothing"));
    EXPECT_EQ(here.surface()["volume_ml"], usual["volume_ml"]);
    for (const json& wrong : {json(-1), json(2), json("much")}) EXPECT_EQ(smooth(wrong)["error"]["kind"], "invalid_input");
}

TEST(SessionSmoothing, CountsWhereStructuresShareTheirBorders) {
    Visit here(label_map());
    ContourSet beside = drawing();
    for (Contour& contour : beside.contours) {
        contour.plane.origin.x += 25;
        for (Vec3& p : contour.points) p.x += 25;
    }
    const Id other = here.session.add_structures("Import", {beside}).front();
    here.call({{"call", "structure.set"}, {"id", here.structure}, {"smoothing", 1e-2}});
    const State state = here.session.state();
    ASSERT_TRUE(state.borders.shared);
    const std::vector<ContourSet> sets{contour_set(state, here.structure), contour_set(state, other)};
    TogetherOptions options;
    const Mask usual = whole_mask(segment_together(sets, here.image->grid, options), 0);
    options.smoothing = {1e-2, std::nullopt};
    const Together smooth = segment_together(sets, here.image->grid, options);
    EXPECT_NE(usual.values, whole_mask(smooth, 0).values);
    EXPECT_EQ(here.exported_mask(), whole_mask(smooth, 0).values);
}

TEST(SessionSmoothing, ThatChangesWhileASurfaceIsOnItsWayLeavesTheLastOne) {
    Visit here(label_map());
    const auto set = [&](double smoothing) {
        const json message{{"seq", 1}, {"call", "structure.set"}, {"id", here.structure}, {"smoothing", smoothing}};
        return here.session.call(message.dump());
    };
    set(1e-2);
    here.session.wait_for_surfaces();
    const double volume_ml = here.surface()["volume_ml"];
    for (int round = 0; round < 12; ++round) set(round % 3 == 0 ? 0 : round % 3 == 1 ? 1e-3 : 1e-2);
    here.session.wait_for_surfaces();
    EXPECT_EQ(here.surface()["stage"], "finished");
    EXPECT_EQ(here.surface()["volume_ml"], volume_ml);
}

}  // namespace
}  // namespace kontur::viewer
