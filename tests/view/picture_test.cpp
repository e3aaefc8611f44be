// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/picture.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <numbers>

#include "kontur/view/moving_picture.h"
#include "kontur/view/panels.h"
#include "support/bodies.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

using test::ball;

ContourSet three_circles(const Vec3& center, double radius) {
    ContourSet set{"ball", {}, {}, {}};
    for (const Vec3& normal : {Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
        Contour contour;
        contour.plane = make_plane(center, normal);
        for (int i = 0; i < 90; ++i) {
            const double a = 2 * std::numbers::pi * i / 90;
            contour.points.push_back(contour.plane.from_uv(radius * std::cos(a), radius * std::sin(a)));
        }
        set.contours.push_back(contour);
    }
    return set;
}

/// Pixels nearer to this colour than a tenth of the range in each channel.
int count_color(const RgbImage& image, const Color& color) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto [r, g, b] = image.at(x, y);
            count += std::abs(r - 255 * color.red) < 25 && std::abs(g - 255 * color.green) < 25 &&
                     std::abs(b - 255 * color.blue) < 25;
        }
    return count;
}

/// A dark CT with one bright voxel, on an oblique grid of either handedness.
Image one_bright_voxel(bool mirrored, const Index3& bright) {
    Image image{{{24, 22, 20}, {}}, {}};
    image.grid.index_to_mm.set_column(0, (mirrored ? -1.0 : 1.0) * Vec3{2, 0.5, 0});
    image.grid.index_to_mm.set_column(1, {-0.5, 2, 0.3});
    image.grid.index_to_mm.set_column(2, {0.2, -0.3, 3});
    image.grid.index_to_mm.translation = {-40, 10, 900};
    std::vector<std::int16_t> values(static_cast<std::size_t>(image.grid.voxel_count()), -1000);
    values[image.grid.offset(bright.i, bright.j, bright.k)] = 2000;
    image.samples = values;
    return image;
}

TEST(SlicePanel, BrightVoxelAppearsAtItsPlaceOnEverySliceOfObliqueGridsOfBothHands) {
    const Index3 bright{15, 8, 12};
    for (const bool mirrored : {false, true}) {
        const Image image = one_bright_voxel(mirrored, bright);
        const Vec3 at = image.grid.center_mm(bright.i, bright.j, bright.k);
        for (const SliceKind kind : {SliceKind::axial, SliceKind::coronal, SliceKind::sagittal}) {
            // The middle of the panel lies 8 mm to the patient's right, in front and below of the voxel.
            Slice slice{.kind = kind, .plane = screen_plane(kind, at)};
            slice.plane.origin += -8 * (slice.plane.u + slice.plane.v);
            Canvas canvas(200, 200);
            picture::draw_slice_panel(canvas, {{0, 0, 200, 200}, 0.5}, slice, {{}, {}, &image, Window{}, 0.2});
            const RgbImage drawn = canvas.image();
            EXPECT_GT(drawn.at(140, 140)[0], 200) << "u and v run right and down";
            EXPECT_LT(drawn.at(60, 140)[0], 60);
            EXPECT_LT(drawn.at(140, 60)[0], 60);
            EXPECT_LT(drawn.at(60, 60)[0], 60);
        }
    }
}

TEST(SlicePanel, SurfaceContourAndCrossingHaveTheirColoursAtTheirPlaces) {
    const TriangleMesh mesh = ball({}, 20, 5);
    ContourSet set = three_circles({}, 10);
    const Slice slice{.kind = SliceKind::axial, .plane = screen_plane(SliceKind::axial, {})};
    Canvas canvas(300, 300);
    picture::draw_slice_panel(canvas, {{0, 0, 300, 300}, 1}, slice, {mesh, set, nullptr, Window{}, 0.2});
    const RgbImage drawn = canvas.image();
    const auto is = [&](double x_mm, double y_mm, const Color& color) {
        const auto [r, g, b] = drawn.at(static_cast<int>(150 + x_mm / 0.2), static_cast<int>(150 + y_mm / 0.2));
        return std::abs(r - 255 * color.red) < 60 && std::abs(g - 255 * color.green) < 60 &&
               std::abs(b - 255 * color.blue) < 60;
    };
    const double diagonal = std::sqrt(0.5);
    EXPECT_TRUE(is(20 * diagonal, 20 * diagonal, picture::kSurface));
    EXPECT_TRUE(is(10 * diagonal, 10 * diagonal, picture::kDrawn));
    EXPECT_TRUE(is(10.5, 0, picture::kDrawn)) << "a dot is wider than the line";
    EXPECT_FALSE(is(10.5 * diagonal, 10.5 * diagonal, picture::kDrawn));
    EXPECT_FALSE(is(0, 0, picture::kDrawn));
}

TEST(SurfacePanel, HiddenHalfOfAContourIsFaint) {
    const TriangleMesh mesh = ball({}, 20, 5);
    Canvas canvas(300, 300), empty(300, 300);
    picture::draw_surface_panel(canvas, {{0, 0, 300, 300}, 1}, {mesh, three_circles({}, 20)}, {.threads = 1});
    picture::draw_surface_panel(empty, {{0, 0, 300, 300}, 1}, {{}, three_circles({}, 20)}, {.threads = 1});
    const int with_surface = count_color(canvas.image(), picture::kDrawn), all = count_color(empty.image(), picture::kDrawn);
    EXPECT_GT(with_surface, 0.4 * all);
    EXPECT_LT(with_surface, 0.75 * all);
}

TEST(Picture, HasTheAskedSizeAndTheSameBytesForAnyNumberOfThreads) {
    const TriangleMesh mesh = ball({10, 20, 30}, 15, 4);
    const ContourSet set = three_circles({10, 20, 30}, 18);
    PictureOptions options{.width_px = 640, .height_px = 400, .facts = {{"Residual", "0.1 mm"}}};
    const RgbImage one = make_picture(mesh, set, nullptr, options, {.threads = 1});
    EXPECT_EQ(one.width, 640);
    EXPECT_EQ(one.height, 400);
    EXPECT_EQ(one.bytes.size(), 3u * 640 * 400);
    EXPECT_EQ(make_picture(mesh, set, nullptr, options, {.threads = 3}), one);
    EXPECT_GT(count_color(one, picture::kSurface), 100);
    EXPECT_GT(count_color(one, picture::kDrawn), 200);
}

TEST(Picture, TakesAnythingDownToNothing) {
    const PictureOptions options{.width_px = 320, .height_px = 200};
    Image image{{{2, 2, 2}, {}}, std::vector<float>(8, 1)};
    ContourSet point{"", {Contour{{}, {{1, 2, 3}}, true, false}, Contour{}}, {}, {}};
    const RgbImage nothing = make_picture({}, {}, nullptr, options);
    EXPECT_NE(nothing, make_picture(ball({}, 10, 2), {}, nullptr, options));
    EXPECT_NE(nothing, make_picture({}, three_circles({}, 10), nullptr, options));
    EXPECT_EQ(make_picture({}, {}, &image, options).width, 320);
    EXPECT_EQ(make_picture({}, point, &image, options).width, 320);
    EXPECT_EQ(make_picture({{{1, 1, 1}}, {}, {{0, 0, 0}}}, point, &image, options).width, 320);
}

TEST(Picture, OfContoursAloneSaysNothingOfASurface) {
    const ContourSet set = three_circles({}, 10);
    const PictureOptions with{.width_px = 640, .height_px = 400};
    PictureOptions without = with;
    without.has_surface = false;
    const RgbImage empty = make_picture({}, set, nullptr, with), alone = make_picture({}, set, nullptr, without);
    EXPECT_NE(alone, empty);
    EXPECT_EQ(count_color(alone, picture::kSurface), 0) << "nothing in the legend";
    EXPECT_GT(count_color(alone, picture::kDrawn), 200);
}

TEST(Picture, RefusesSizesThatNobodyCanReadOrStore) {
    EXPECT_KONTUR_ERROR(make_picture({}, {}, nullptr, {.width_px = 319}), ErrorKind::invalid_input, "319 x 1000");
    EXPECT_KONTUR_ERROR(make_picture({}, {}, nullptr, {.height_px = -1}), ErrorKind::invalid_input, "1600 x -1");
    EXPECT_KONTUR_ERROR(make_picture({}, {}, nullptr, {.width_px = 20000}), ErrorKind::too_large, "20000");
}

TEST(Picture, RefusesAMeshThatIsNotFinite) {
    for (const double bad : {std::nan(""), 1e300}) {
        const TriangleMesh mesh{{{bad, 0, 0}, {0, bad, 0}, {0, 0, bad}}, {}, {{0, 1, 2}}};
        EXPECT_KONTUR_ERROR(make_picture(mesh, {}, nullptr), ErrorKind::invalid_input, "point 1 of the mesh");
    }
}

TEST(Picture, ComesOutWithoutAnyFont) {
    // Only effective where this test has the process to itself, as under ctest: fontconfig reads its settings once.
    const test::TemporaryFolder folder;
    std::ofstream(folder / "fonts.conf") << "<?xml version=\"1.0\"?><fontconfig></fontconfig>";
    setenv("FONTCONFIG_FILE", (folder / "fonts.conf").c_str(), 1);
    const RgbImage picture =
        make_picture(ball({}, 10, 3), three_circles({}, 12), nullptr, {.width_px = 640, .height_px = 400});
    EXPECT_GT(count_color(picture, picture::kSurface), 100);
    EXPECT_GT(count_color(picture, picture::kDrawn), 200);
}

TEST(WindowAbout, ShowsAHotLesionOfWhichTheWholeImageKnowsNothing) {
    Image image{{{60, 60, 60}, {}}, {}};
    std::vector<float> values(60 * 60 * 60);
    for (std::int64_t k = 0; k < 60; ++k)
        for (std::int64_t j = 0; j < 60; ++j)
            for (std::int64_t i = 0; i < 60; ++i)
                values[image.grid.offset(i, j, k)] = distance(image.grid.center_mm(i, j, k), {20, 20, 30}) < 5
                                                         ? 12.0F
                                                         : 0.1F * static_cast<float>((i + j + k) % 10);
    image.samples = values;
    const Box3 lesion{{15, 15, 25}, {25, 25, 35}};
    EXPECT_LT(suggest_window(image).center + suggest_window(image).width / 2, 2);
    const Window window = picture::window_about(image, lesion);
    EXPECT_NEAR(window.center + window.width / 2, 12, 1e-6);
    EXPECT_NEAR(window.center - window.width / 2, 0, 1e-6);
    for (const Box3& box : {Box3{}, Box3{{-900, -900, -900}, {-800, -800, -800}}})
        EXPECT_GT(picture::window_about(image, box).width, 0) << "no object, or one beside the image";
}

TEST(InMl, HasFourDigitsHoweverSmallTheObject) {
    EXPECT_EQ(in_ml(1104.36), "1104 ml");
    EXPECT_EQ(in_ml(53.3), "53.30 ml");
    EXPECT_EQ(in_ml(0.004), "0.004000 ml") << "a mask of 4 mm^3";
    EXPECT_EQ(in_ml(1.234567e-7), "0.0000001235 ml");
}

TEST(Rounded, KeepsTheSignificantDigits) {
    EXPECT_EQ(picture::rounded(1177.65, 4), "1178");
    EXPECT_EQ(picture::rounded(397.0635, 4), "397.1");
    EXPECT_EQ(picture::rounded(2.54812, 4), "2.548");
    EXPECT_EQ(picture::rounded(50, 1), "50");
    EXPECT_EQ(picture::rounded(0.2, 1), "0.2");
    EXPECT_EQ(picture::rounded(0, 4), "0.000");
    EXPECT_EQ(picture::rounded(-0.5, 2), "-0.50");
}

/// A ball that shrinks from 20 to 14 mm over 5 frames, at its first and its last one.
struct ShrinkingBall {
    TriangleMesh large = ball({0, 0, 0}, 20, 4), small = ball({0, 0, 0}, 14, 4);
    ContourSet drawn = three_circles({}, 20), none;
    std::vector<Vec3> shown = large.points;
    MovingPictureContent content{{{"Largest", large, drawn, nullptr}, {"Smallest", small, none, nullptr}},
                                 drawn,
                                 shown,
                                 {{33, 28, 22, 16, 11}, {}, {0}, 0, 4},
                                 {}};
};

TEST(MovingPicture, BothMomentsAreAtOneScale) {
    ShrinkingBall here;
    const RgbImage both = make_moving_picture(here.content, {.width_px = 800, .height_px = 500});
    here.content.moments.pop_back();
    here.content.moments.push_back({"Largest", here.large, here.drawn, nullptr});
    const RgbImage twice = make_moving_picture(here.content, {.width_px = 800, .height_px = 500});
    const auto line = [](const RgbImage& image, int from, int to) {
        int count = 0;
        for (int y = from; y < to; ++y)
            for (int x = 0; x < image.width / 3; ++x) {
                const auto [r, g, b] = image.at(x, y);
                count += b > 120 && b > r + 30;  // the surface
            }
        return count;
    };
    const int large = line(both, 40, 255), small = line(both, 262, 470);
    EXPECT_NEAR(static_cast<double>(small) / large, 0.49, 0.1) << "(14 / 20)^2";
    EXPECT_GT(line(twice, 262, 470), 0.9 * large);
}

TEST(MovingPicture, TheCurveHasABandWhereIntervalsAreKnown) {
    ShrinkingBall here;
    const RgbImage without = make_moving_picture(here.content, {.width_px = 800, .height_px = 500});
    here.content.curve.intervals = {{30, 36}, {22, 34}, {17, 27}, {12, 20}, {10, 12}};
    const RgbImage with = make_moving_picture(here.content, {.width_px = 800, .height_px = 500});
    EXPECT_NE(without, with);
    for (int y = 0; y < with.height; ++y)
        for (int x = 0; x < with.width / 2; ++x) ASSERT_EQ(with.at(x, y), without.at(x, y)) << "beside the curve";
    EXPECT_EQ(with, make_moving_picture(here.content, {.width_px = 800, .height_px = 500}, {.threads = 1}));
}

TEST(MovingPicture, RefusesWhatItCannotShow) {
    ShrinkingBall here;
    EXPECT_KONTUR_ERROR(make_moving_picture(here.content, {.width_px = 100}), ErrorKind::invalid_input, "100 x 1000 pixels");
    here.content.curve.values_ml.clear();
    EXPECT_KONTUR_ERROR(make_moving_picture(here.content), ErrorKind::invalid_input, "there is no volume of a frame");
    here.content.moments.clear();
    EXPECT_KONTUR_ERROR(make_moving_picture(here.content), ErrorKind::invalid_input, "there is no moment to show");
}

}  // namespace
}  // namespace kontur
