// SPDX-License-Identifier: Apache-2.0
// A structure that was drawn at several times: surfaces, volumes and files of a session are those of segment_moving.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "kontur/io/contours.h"
#include "kontur/io/image.h"
#include "kontur/moving_sureness.h"
#include "kontur/segment_moving.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/session/session.h"

namespace kontur::viewer {
namespace {

using kontur::test::TemporaryFolder;
using nlohmann::json;

constexpr int kTimes = 6, kOwn = 2;

/// A session on a flat image of six frames, opened at the third.
struct BeatingSession {
    TemporaryFolder folder;
    std::vector<json> events;
    std::mutex mutex;
    std::unique_ptr<Session> session;  ///< last: its threads tell events

    BeatingSession() { open(); }

    void open() {
        session.reset();
        OpenedImage opened{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}};
        opened.times = {kTimes, kOwn, [](int) { return test::flat_image(); }, 0.05};
        session = std::make_unique<Session>(std::move(opened), folder.path() / "a.kontur");
        session->on_event([this](const std::string& text) {
            const std::scoped_lock lock(mutex);
            events.push_back(json::parse(text));
        });
    }

    json call(json message) {
        message["seq"] = 1;
        return json::parse(session->call(message.dump()));
    }

    /// A circle of a ball around the image's middle, across z.
    json circle(Id structure, double z, double ball_mm, std::optional<int> time) const {
        const double radius = std::sqrt(ball_mm * ball_mm - (z - 20) * (z - 20));
        json control = json::array();
        for (int n = 0; n < 24; ++n)
            control.push_back(
                {{"at",
                  {20 + radius * std::cos(n * std::numbers::pi / 12), 20 + radius * std::sin(n * std::numbers::pi / 12), z}},
                 {"kind", "spline"}});
        json message{{"call", "contour.add"},
                     {"structure", structure},
                     {"plane", {{"origin", {20, 20, z}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}}},
                     {"control", control}};
        if (time) message["time"] = *time;
        return message;
    }

    void draw(Id structure, double ball_mm, std::optional<int> time) {
        for (const double z : {12.0, 20.0, 28.0}) {
            const json reply = call(circle(structure, z, ball_mm, time));
            ASSERT_TRUE(reply.contains("result")) << reply;
        }
    }

    Id two_frames() {
        const Id id = call({{"call", "structure.add"}})["result"]["structure"]["id"];
        draw(id, 15, std::nullopt);
        draw(id, 11, 5);
        EXPECT_TRUE(call({{"call", "cycle.set"}, {"repeats", true}}).contains("result"));
        session->wait_for_surfaces();
        return id;
    }

    json motion() { return json::parse(session->greeting())["motions"].at(0); }

    /// As `segment_moving` makes it of the file that is exported.
    MovingSegmentation by_library(Id id) {
        const auto path = folder.path() / "drawn.json";
        std::ofstream(path, std::ios::binary) << session->exported("contours.json", id).bytes;
        const ContourSet set = read_contours(path).contours;
        const Grid grid = test::flat_image()->grid;
        return segment_moving(set, grid, std::vector<double>{1, 2, 3, 4, 5, 6}, {.drawn_on = grid});
    }

    Mask mask_in(const Download& file, std::optional<std::int64_t> frame) {
        const auto path = folder.path() / "mask.nii.gz";
        std::ofstream(path, std::ios::binary) << file.bytes;
        ReadImageOptions options;
        options.frame = frame;
        return select_nonzero(read_image(path, options));
    }
};

/// JSON of a reply, and one of its arrays.
std::pair<json, std::vector<float>> numbers(const std::string& bytes, const char* array_name) {
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data(), 4);
    json head = json::parse(bytes.substr(4, size));
    const json& array = head["arrays"][array_name];
    std::vector<float> numbers(array["count"].get<std::size_t>());
    std::memcpy(numbers.data(), bytes.data() + 4 + size + array["offset"].get<std::size_t>(), 4 * numbers.size());
    return {std::move(head), std::move(numbers)};
}

std::string mesh_bytes(Session& session, Id id, int time) { return session.mesh(id, false, {.widths = true, .time = time}); }

std::pair<json, std::vector<float>> mesh_at(Session& session, Id id, int time) {
    return numbers(mesh_bytes(session, id, time), "positions");
}

double farthest_mm(const std::vector<float>& positions) {
    double most = 0;
    for (std::size_t n = 0; n + 2 < positions.size(); n += 3)
        most = std::max(most, distance({positions[n], positions[n + 1], positions[n + 2]}, {20, 20, 20}));
    return most;
}

TEST(MovingSession, VolumesAndFilesAreThoseOfTheLibrary) {
    BeatingSession here;
    const Id id = here.two_frames();
    const MovingSegmentation made = here.by_library(id);
    const json motion = here.motion();
    EXPECT_TRUE(motion["finished"]);
    EXPECT_EQ(motion["curve"]["volumes_ml"].get<std::vector<double>>(), made.volumes.volumes_ml);
    EXPECT_EQ(motion["curve"]["largest"], made.volumes.largest);
    EXPECT_EQ(motion["curve"]["ejection_fraction"].get<double>(), made.volumes.ejection_fraction());
    EXPECT_GT(made.volumes.ejection_fraction(), 0.5);
    ASSERT_EQ(motion["curve"]["intervals_ml"].size(), kTimes);
    EXPECT_EQ(motion["curve"]["intervals_ml"][3][1].get<double>(), made.volumes.intervals[3].high_ml);
    EXPECT_EQ(motion["curve"]["ejection_interval"][0].get<double>(), made.volumes.ejection_interval()->low);
    const Download all = here.session->exported("masks.nii.gz", id);
    for (int time = 0; time < kTimes; ++time) {
        EXPECT_EQ(here.mask_in(all, time + 1).values, made.masks[time].values) << time;
        const Download one = here.session->exported("mask.nii.gz", id, {}, time);
        EXPECT_EQ(here.mask_in(one, {}).values, made.masks[time].values) << time;
        EXPECT_EQ(one.file_name, fmt::format("flat_Structure_1_frame_{}.nii.gz", time + 1));
    }
    EXPECT_EQ(here.session->exported("volumes.csv", id).bytes, volumes_csv(made.times, made.volumes, made.moments, 0.05));
}

TEST(MovingSession, LabelsOfAllFramesAreTheLabelMapsOfEach) {
    BeatingSession here;
    here.two_frames();
    const Id still = here.call({{"call", "structure.add"}})["result"]["structure"]["id"];
    here.draw(still, 9, 3);
    const Id small = here.call({{"call", "structure.add"}})["result"]["structure"]["id"];
    here.draw(small, 8.5, std::nullopt);
    here.draw(small, 9.5, 4);
    const auto path = here.folder.path() / "labels.nii.gz";
    const auto labels_in = [&](const Download& file, std::optional<std::int64_t> frame) {
        std::ofstream(path, std::ios::binary) << file.bytes;
        ReadImageOptions options;
        options.frame = frame;
        return read_image(path, options).samples;
    };
    const Download all = here.session->exported("label_frames.nii.gz", {});
    EXPECT_EQ(all.file_name, "flat_label_frames.nii.gz");
    for (int time = 0; time < kTimes; ++time)
        EXPECT_EQ(labels_in(all, time + 1), labels_in(here.session->exported("labels.nii.gz", {}, {}, time), {})) << time;
}

TEST(MovingSession, EachFrameHasItsSurface) {
    BeatingSession here;
    const Id id = here.two_frames();
    const json motion = here.motion();
    for (const auto& [time, radius] : {std::pair(kOwn, 15.0), std::pair(5, 11.0)}) {
        const auto [head, positions] = mesh_at(*here.session, id, time);
        EXPECT_EQ(head["revision"], motion["revisions"][time]);
        EXPECT_NEAR(farthest_mm(positions), radius, 1.2) << time;
    }
    const double between = farthest_mm(mesh_at(*here.session, id, 4).second);
    EXPECT_GT(between, 11.2);
    EXPECT_LT(between, 15.5);
    json slice{
        {"plane", {{"origin", {0, 0, 20}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}, {"mm_per_pixel", 1}}},
        {"width", 40},
        {"height", 40},
        {"window", {{"center", 0}, {"width", 1}}},
        {"pixels", false},
        {"time", 4}};
    const std::string bytes = here.session->slice(slice.dump());
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data(), 4);
    const json head = json::parse(bytes.substr(4, size));
    EXPECT_EQ(head["outlines"].at(0)["revision"], motion["revisions"][4]);
    EXPECT_TRUE(head["contours"].empty()) << "nothing was drawn in this frame";
}

TEST(MovingSession, HowSureAFrameIsIsWhatTheLibrarySays) {
    BeatingSession here;
    const Id id = here.two_frames();
    const MovingSegmentation made = here.by_library(id);
    for (const int time : {kOwn, 4}) {
        const std::vector<float> positions = numbers(mesh_bytes(*here.session, id, time), "positions").second;
        const std::vector<float> widths = numbers(mesh_bytes(*here.session, id, time), "half_widths_mm").second;
        std::vector<Vec3> points;
        for (std::size_t n = 0; n + 2 < positions.size(); n += 3)
            points.push_back({positions[n], positions[n + 1], positions[n + 2]});
        const std::vector<double> expected = half_widths_mm(made.function, made.moments, points, time + 1);
        ASSERT_EQ(widths.size(), expected.size());
        for (std::size_t n = 0; n < widths.size(); ++n) EXPECT_NEAR(widths[n], expected[n], 0.05) << time << " " << n;
    }
}

TEST(MovingSession, WhatIsUndoneAndWhatIsOpenedAgainIsWhatItWas) {
    BeatingSession here;
    const Id id = here.two_frames();
    const json before = here.motion()["curve"];
    const Id last = here.session->state().contours.rbegin()->first;
    here.call({{"call", "contour.remove"}, {"ids", {last}}});
    here.session->wait_for_surfaces();
    EXPECT_NE(here.motion()["curve"], before);
    EXPECT_EQ(here.call({{"call", "undo"}})["result"]["label"], "Delete a contour");
    here.session->wait_for_surfaces();
    EXPECT_EQ(here.motion()["curve"], before);
    here.open();
    here.session->wait_for_surfaces();
    EXPECT_EQ(here.motion()["curve"], before);
    EXPECT_EQ(json::parse(here.session->greeting())["cycle_frames"], kTimes);
    EXPECT_EQ(here.session->state().contours.at(last)->time, 5);
    EXPECT_EQ(here.call({{"call", "undo"}})["result"]["label"], "The motion repeats");
    EXPECT_TRUE(json::parse(here.session->greeting())["cycle_frames"].is_null());
    here.call({{"call", "structure.remove"}, {"id", id}});
    EXPECT_TRUE(json::parse(here.session->greeting())["motions"].empty());
}

TEST(MovingSession, WhatWasDrawnInOneFrameIsWhatItWas) {
    BeatingSession here;
    const Id id = here.call({{"call", "structure.add"}})["result"]["structure"]["id"];
    here.draw(id, 15, std::nullopt);
    here.session->wait_for_surfaces();
    EXPECT_TRUE(json::parse(here.session->greeting())["motions"].empty());
    const json drawn = json::parse(here.session->exported("contours.json", id).bytes);
    for (const json& plane : drawn["planes"])
        for (const json& contour : plane["contours"]) EXPECT_FALSE(contour.contains("frame"));
    const json greeting = json::parse(here.session->greeting());
    for (const json& contour : greeting["contours"]) EXPECT_FALSE(contour.contains("time"));
    for (const json& event : here.events) EXPECT_NE(event["event"], "motion");
    EXPECT_THROW(here.session->exported("masks.nii.gz", id), Error);
    // A contour of the opened frame that says so is one that does not.
    here.draw(id, 14, kOwn);
    EXPECT_FALSE(here.session->state().contours.rbegin()->second->time);
}

TEST(MovingSession, AFirstContourInAFrameIsPreviewedWithWhatIsSeenThere) {
    BeatingSession here;
    const Id id = here.two_frames();
    json slice{
        {"plane", {{"origin", {0, 0, 20}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}, {"mm_per_pixel", 1}}},
        {"width", 40},
        {"height", 40},
        {"window", {{"center", 0}, {"width", 1}}},
        {"pixels", false},
        {"time", 0}};
    here.session->slice(slice.dump());  // somebody looks at the first frame
    json draft = here.circle(id, 20, 13, 0);
    draft["draft"] = true;
    EXPECT_TRUE(here.call(draft).contains("result"));
    here.session->wait_for_surfaces();
    const auto [head, positions] = mesh_at(*here.session, id, 0);
    double low = 40, high = 0;
    for (std::size_t n = 2; n < positions.size(); n += 3) {
        low = std::min<double>(low, positions[n]);
        high = std::max<double>(high, positions[n]);
    }
    EXPECT_GT(high - low, 18) << "a body, not a slice";
    EXPECT_LT(high - low, 34);
    here.call({{"call", "draft.drop"}});
    here.session->wait_for_surfaces();
    EXPECT_EQ(here.session->state().contours.size(), 6u);
}

TEST(MovingSession, WhatCannotBeSaysSo) {
    BeatingSession here;
    const Id id = here.two_frames();
    EXPECT_EQ(here.call(here.circle(id, 20, 13, 6))["error"]["message"], "there is no time 6: the last one is time 5");
    EXPECT_THROW(here.session->exported("contours.mrk.json", id), Error);
    EXPECT_THROW(here.session->exported("mask.nii.gz", id, {}, 9), Error);
}

}  // namespace
}  // namespace kontur::viewer
