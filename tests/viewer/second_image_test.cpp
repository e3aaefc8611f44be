// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/session/session.h"

// An image that is shown beside the project's own: its values on slices, its edges, and what is kept of it.

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr double kRadius_mm = 10;

/// A ball around `test::kPlane`'s origin, on a grid that is turned, anisotropic and larger than that of the flat image.
std::shared_ptr<const Image> ball() {
    Grid grid{{40, 30, 24}, {}};
    const double c = std::cos(0.3), s = std::sin(0.3);
    grid.index_to_mm.set_column(0, 1.5 * Vec3{c, s, 0});
    grid.index_to_mm.set_column(1, 1.8 * Vec3{-s, c, 0});
    grid.index_to_mm.set_column(2, {0, 0, 2.5});
    const Vec3 middle = grid.index_to_mm.apply({19.5, 14.5, 11.5});
    grid.index_to_mm.translation = test::kPlane.origin - middle;
    std::vector<float> values;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                values.push_back(static_cast<float>(
                    8 / (1 + std::exp(distance(grid.center_mm(i, j, k), test::kPlane.origin) - kRadius_mm))));
    return std::make_shared<const Image>(Image{grid, values});
}

OpenedImage opened_ball(const std::string& modality = "PT") {
    OpenedImage opened{ball(), "ball", {"/images/ball.nii", "ball-1", {.series_uid = {}, .volume = {}, .frame = 2}}, {}};
    opened.identity.modality = modality;
    opened.identity.unit = "SUV (g/ml)";
    return opened;
}

struct Visit {
    json call(json message) {
        message["seq"] = 1;
        return json::parse(session.call(message.dump()));
    }
    json images() { return json::parse(session.greeting())["images"]; }

    kontur::test::TemporaryFolder folder;
    Session session{{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}}, folder.path() / "a.kontur"};
};

/// A turned plane through the ball, in pixels of 0.7 mm.
json slice_request(int image) {
    const double c = std::cos(0.5), s = std::sin(0.5);
    const json plane{
        {"origin", {10, 10, 16}}, {"u", {c, 0, -s}}, {"v", {0, 1, 0}}, {"normal", {s, 0, c}}, {"mm_per_pixel", 0.7}};
    return {{"view", "axial"}, {"plane", plane},     {"width", 33},      {"height", 29},
            {"image", image},  {"pixels", "values"}, {"outlines", false}};
}

json head_of(const std::string& reply) {
    std::uint32_t length = 0;
    std::memcpy(&length, reply.data(), sizeof length);
    return json::parse(reply.substr(sizeof length, length));
}

TEST(SecondImage, ItsValuesComeOnAnyPlaneAsTheyAreThere) {
    Visit here;
    here.session.put_second_image(opened_ball());
    const json request = slice_request(1);
    const std::string reply = here.session.slice(request.dump());
    std::uint32_t length = 0;
    std::memcpy(&length, reply.data(), sizeof length);
    const json head = head_of(reply);
    const double first = head["values"]["first"], step = head["values"]["step"];
    const std::size_t begin = sizeof length + length + head["arrays"]["values"]["offset"].get<std::size_t>();
    const auto image = ball();
    const Affine3 mm_to_index = image->grid.index_to_mm.inverse();
    const json& told = request["plane"];
    const auto vec = [](const json& v) { return Vec3{v[0], v[1], v[2]}; };
    const json& samples = head["samples"];
    const int columns = samples["columns"], rows = samples["rows"];
    EXPECT_LT(columns * rows, 33 * 29) << "no more than the image has";
    const auto pixel = [&](int side, int n) {
        return samples["first"][side].get<double>() + n * samples["step"][side].get<double>();
    };
    int inside = 0;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            std::uint16_t code = 0;
            std::memcpy(&code, reply.data() + begin + sizeof code * static_cast<std::size_t>(row * columns + column),
                        sizeof code);
            const Vec3 at = vec(told["origin"]) + 0.7 * (pixel(0, column) * vec(told["u"]) + pixel(1, row) * vec(told["v"]));
            const double value = interpolate(*image, mm_to_index, at, std::numeric_limits<double>::quiet_NaN());
            ASSERT_EQ(code == 0, std::isnan(value));
            if (code == 0) continue;
            ++inside;
            ASSERT_NEAR(first + step * (code - 1), value, 1e-3);
        }
    EXPECT_GT(inside, columns * rows / 2);
}

TEST(SecondImage, BothValuesAreToldUnderThePointer) {
    Visit here;
    const json center{20, 20, 20}, outside{-7, -7, 20};
    EXPECT_EQ(here.call({{"call", "value"}, {"at", center}})["result"]["values"], (json{0.0}));
    here.session.put_second_image(opened_ball());
    const json both = here.call({{"call", "value"}, {"at", center}})["result"]["values"];
    ASSERT_EQ(both.size(), 2u);
    EXPECT_NEAR(both[1].get<double>(), 8, 0.1);
    EXPECT_EQ(here.call({{"call", "value"}, {"at", outside}})["result"]["values"][0], nullptr);
}

TEST(SecondImage, IsToldWithItsUnitAndAWindowFromZeroWhereATracerIsCounted) {
    Visit here;
    EXPECT_EQ(here.images(), json::array());
    here.session.put_second_image(opened_ball());
    const json pet = here.images()[0];
    EXPECT_EQ(pet["image"], 1);
    EXPECT_EQ(pet["unit"], "SUV (g/ml)");
    EXPECT_TRUE(pet["emission"]);
    const double center = pet["window"]["center"], width = pet["window"]["width"];
    EXPECT_DOUBLE_EQ(center - width / 2, 0);
    EXPECT_GT(center + width / 2, 4);
    EXPECT_EQ(pet["presets"][1]["name"], "SUV 0 to 5");
    here.session.put_second_image(opened_ball("MR"));
    EXPECT_FALSE(here.images()[0]["emission"]);
    EXPECT_EQ(here.images().size(), 1u);
}

TEST(SecondImage, TheWindowOfATracerEndsWhereOneOf200VoxelsLies) {
    std::vector<std::int16_t> values(64000, 3);
    std::fill(values.begin(), values.begin() + 640, std::int16_t{90});
    const Image image{{{40, 40, 40}, {}}, values};
    EXPECT_EQ(emission_window(image, "Bq/ml"), (Window{45, 90}));
    EXPECT_EQ(emission_window(*test::flat_image(), "Bq/ml"), (Window{0.5, 1}));
}

TEST(SecondImage, LittleUptakeIsNotShownAsMuch) {
    const Image image{{{40, 40, 40}, {}}, std::vector<float>(64000, 2.f)};
    EXPECT_EQ(emission_window(image, "SUV (g/ml)"), (Window{2.5, 5}));
    EXPECT_EQ(emission_window(image, "Bq/ml"), (Window{1, 2}));
}

TEST(SecondImage, IsKeptWithTheProjectUntilItIsRemoved) {
    kontur::test::TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    const OpenedImage flat{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}};
    {
        Session session(flat, path);
        EXPECT_EQ(session.kept_second_image(), std::nullopt);
        session.put_second_image(opened_ball());
    }
    {
        Session session(flat, path);
        EXPECT_EQ(session.kept_second_image(), opened_ball().reference);
        EXPECT_EQ(json::parse(session.greeting())["images"], json::array()) << "nobody has read it yet";
        EXPECT_TRUE(json::parse(session.call(R"({"seq": 1, "call": "image.remove", "image": 1})")).contains("result"));
    }
    EXPECT_EQ(Session(flat, path).kept_second_image(), std::nullopt);
}

TEST(SecondImage, WhatDoesNotFitChangesNothing) {
    Visit here;
    here.session.put_second_image(opened_ball());
    OpenedImage far = opened_ball();
    Image moved = *far.image;
    moved.grid.index_to_mm.translation.x += 500;
    far.image = std::make_shared<const Image>(moved);
    far.title = "far";
    EXPECT_KONTUR_ERROR(here.session.put_second_image(std::move(far)), ErrorKind::invalid_input, "far and flat do not meet");
    EXPECT_EQ(here.images()[0]["title"], "ball");
    EXPECT_EQ(here.session.kept_second_image(), opened_ball().reference);
}

TEST(SecondImage, OfOneThatHasGoneASliceHasNoPixelsAndIsNoError) {
    Visit here;
    here.session.put_second_image(opened_ball());
    EXPECT_FALSE(head_of(here.session.slice(slice_request(1).dump())).contains("gone"));
    here.call({{"call", "image.remove"}, {"image", 1}});
    const json head = head_of(here.session.slice(slice_request(1).dump()));
    EXPECT_TRUE(head["gone"]);
    EXPECT_FALSE(head.contains("values"));
    EXPECT_FALSE(head["arrays"].contains("pixels"));
}

TEST(SecondImage, OtherNumbersAreRefused) {
    Visit here;
    here.session.put_second_image(opened_ball());
    EXPECT_KONTUR_ERROR(here.session.slice(slice_request(2).dump()), ErrorKind::invalid_input,
                        "there is no image 2: the last one is image 1");
    EXPECT_KONTUR_ERROR(here.session.slice(slice_request(-1).dump()), ErrorKind::invalid_input,
                        "'image' is -1; a whole number from 0 to 15");
    EXPECT_EQ(here.call({{"call", "image.remove"}, {"image", 0}})["error"]["kind"], "invalid_input");
}

// Wires

json plane_json() {
    return {{"origin", {20, 20, 20}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}, {"mm_per_pixel", 0.5}};
}

/// Four points around the ball, of wires that follow this image.
json square_of_wires(int image) {
    json control = json::array();
    for (const auto& [x, y] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}})
        control.push_back({{"at", {20 + kRadius_mm * x, 20 + kRadius_mm * y, 20}}, {"kind", "wire"}, {"image", image}});
    return control;
}

/// How far the closed line leaves the ball's border at most, at its points and half way between them.
double off_the_ball_mm(const json& points) {
    const auto point = [&](std::size_t n) {
        const json& p = points[n % points.size()];
        return Vec3{p[0], p[1], p[2]};
    };
    double worst = 0;
    for (std::size_t n = 0; n < points.size(); ++n)
        for (const Vec3& p : {point(n), 0.5 * (point(n) + point(n + 1))})
            worst = std::max(worst, std::abs(distance(p, test::kPlane.origin) - kRadius_mm));
    return worst;
}

TEST(SecondImage, AWireFollowsTheImageThatItsPointNames) {
    Visit here;
    here.session.put_second_image(opened_ball());
    const auto drawn = [&](int image) {
        return here.call(
            {{"call", "path"}, {"plane", plane_json()}, {"control", square_of_wires(image)}, {"closed", true}})["result"];
    };
    EXPECT_LT(off_the_ball_mm(drawn(1)["points"]), 1.5);
    EXPECT_GT(off_the_ball_mm(drawn(0)["points"]), 2.5) << "straight lines, where the image is flat";
    EXPECT_EQ(drawn(1)["control"][0]["image"], 1);
    EXPECT_FALSE(drawn(0)["control"][0].contains("image"));
}

TEST(SecondImage, AContourGoesOnFollowingTheImageThatItWasDrawnOn) {
    Visit here;
    here.session.put_second_image(opened_ball());
    here.session.begin_with({{}});
    const Id structure = here.session.state().structures.begin()->first;
    const json added = here.call(
        {{"call", "contour.add"}, {"structure", structure}, {"plane", plane_json()}, {"control", square_of_wires(1)}});
    const json contour = added["result"]["contour"];
    EXPECT_LT(off_the_ball_mm(contour["points"]), 1.5);
    const auto move = [&] {
        return here.call({{"call", "contour.move_point"},
                          {"id", contour["id"]},
                          {"index", 0},
                          {"to", {30.8, 20.5, 20}},
                          {"mm_per_pixel", 0.5}})["result"]["contour"];
    };
    const json moved = move();
    EXPECT_LT(off_the_ball_mm(moved["points"]), 1.5) << "the point snaps to the second image's edge";
    here.call({{"call", "image.remove"}, {"image", 1}});
    EXPECT_GT(off_the_ball_mm(move()["points"]), 2)
        << "without it the first image counts, in which there is nothing to follow";
}

/// A ball of 8 mm around the origin of `test::kPlane`, from three circles; `shift` mm along x.
ContourSet drawn_ball(const std::string& name, double shift) {
    ContourSet set;
    set.name = name;
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        Contour contour{make_plane(test::kPlane.origin + Vec3{shift, 0, 0}, normal), {}, true, false};
        for (int n = 0; n < 60; ++n)
            contour.points.push_back(
                contour.plane.from_uv(8 * std::cos(n * std::numbers::pi / 30), 8 * std::sin(n * std::numbers::pi / 30)));
        set.contours.push_back(contour);
    }
    return set;
}

TEST(SecondImage, StatisticsAreThoseOfTheVoxelsOfItsOwnGridInsideTheSurface) {
    for (const bool shares : {false, true}) {
        Visit here;
        here.session.add_structures("Import", {drawn_ball("Ball", 0)});
        here.call({{"call", "borders.set"}, {"shared", shares}});
        EXPECT_FALSE(json::parse(here.session.statistics()).contains("second"));
        here.session.put_second_image(opened_ball());
        const json told = json::parse(here.session.statistics());
        EXPECT_EQ(told["second"]["unit"], "SUV (g/ml)");
        const json& found = told["structures"][0]["second"];
        // By hand, in the ball that was drawn: a fit of three circles is not that ball to the last voxel.
        const auto image = ball();
        double sum = 0, squares = 0, count = 0;
        for (std::int64_t k = 0; k < image->grid.size.k; ++k)
            for (std::int64_t j = 0; j < image->grid.size.j; ++j)
                for (std::int64_t i = 0; i < image->grid.size.i; ++i) {
                    const double away = distance(image->grid.center_mm(i, j, k), test::kPlane.origin);
                    if (away >= 8) continue;
                    const double value = 8 / (1 + std::exp(away - kRadius_mm));
                    ++count, sum += value, squares += value * value;
                }
        EXPECT_NEAR(found["voxels"].get<double>() / count, 1, 0.04);
        EXPECT_NEAR(found["mean"].get<double>(), sum / count, 0.03);
        EXPECT_NEAR(found["deviation"].get<double>(), std::sqrt(squares / count - sum * sum / count / count), 0.05);
        EXPECT_EQ(found["points_beyond"], 0);
        EXPECT_NEAR(told["structures"][0]["voxels"].get<double>(), 4.0 / 3 * std::numbers::pi * 512, 100)
            << "of the first image's";
    }
}

TEST(SecondImage, OnTheFirstImagesGridStatisticsUseTheFirstImagesVoxels) {
    Visit here;
    here.session.add_structures("Import", {drawn_ball("Ball", 0)});
    OpenedImage ramp{std::make_shared<const Image>(Image{test::flat_image()->grid, std::vector<float>(64000, 3)}),
                     "ramp",
                     {"/images/ramp.nii", "ramp", {}},
                     {}};
    here.session.put_second_image(std::move(ramp));
    const json row = json::parse(here.session.statistics())["structures"][0];
    EXPECT_EQ(row["second"]["voxels"], row["voxels"]);
    EXPECT_EQ(row["second"]["mean"], 3);
}

TEST(SecondImage, AStructureThatLiesBeyondItHasNoVoxelsThere) {
    Visit here;
    here.session.add_structures("Import", {drawn_ball("Beyond", 10), drawn_ball("Partly", 2), drawn_ball("Within", -7)});
    OpenedImage half = opened_ball();
    const Grid grid{{20, 30, 40}, {}};  // up to x = 19.5
    half.image = std::make_shared<const Image>(Image{grid, std::vector<float>(20 * 30 * 40, 2)});
    here.session.put_second_image(std::move(half));
    const json rows = json::parse(here.session.statistics())["structures"];
    EXPECT_EQ(rows[0]["second"], (json{{"voxels", 0}}));
    EXPECT_GT(rows[1]["second"]["points_beyond"].get<int>(), 0);
    EXPECT_GT(rows[1]["second"]["voxels"].get<int>(), 200);
    EXPECT_LT(rows[1]["second"]["voxels"].get<int>(), rows[1]["voxels"].get<int>());
    EXPECT_EQ(rows[2]["second"]["mean"], 2);
}

}  // namespace
}  // namespace kontur::viewer
