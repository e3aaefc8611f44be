// SPDX-License-Identifier: Apache-2.0
// What two of three planes show may be too little of the object; a surface displaced on purpose tells whether the image
// knows the border.
#include "kontur/image/displace.h"

#include <gtest/gtest.h>

#include "kontur/pipeline.h"
#include "support/lobed_body.h"

namespace kontur {
namespace {

using namespace test;

std::vector<Plane> three() {
    std::vector<Plane> planes = orthogonal_planes();
    planes.resize(3);
    return planes;
}

std::optional<HeldOutErrors> displaced(const ContourSet& contours, const Image& image) {
    const Drawing drawing = read_drawing(contours, FillRule::even_odd);
    const StageOptions stages = stage_options({}, drawing.diameter_mm());
    return displace_planes(drawing, image, fit(prepare(drawing, stages.prepare), stages.fit).function, {});
}

TEST(Displace, ThreePlanesAreEnoughToTrustAnImageThatShowsTheBorder) {
    const ContourSet contours = drawn_on(three());
    const FollowedImage r = follow_image_of(contours, image_of(cube_grid(1.5), body_look, 8));
    EXPECT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    EXPECT_EQ(r.with_image.report.planes_left_out, 3U);
    EXPECT_LT(surface_error(r.with_image.fitted.function, contours), 0.6 * surface_error(r.plain.function, contours));
    const std::optional<HeldOutErrors> errors = displaced(contours, image_of(cube_grid(1.5), body_look, 8));
    ASSERT_TRUE(errors);
    EXPECT_EQ(errors->planes(), 3U);
    EXPECT_EQ(errors->weight(kTakenBack), 1);
    EXPECT_LT(errors->with_mm(), (1 - kTakenBack.to) * errors->without_mm());
}

TEST(Displace, AnImageThatLiesBesideTheDrawingIsNotUsed) {
    const ContourSet contours = drawn_on(three());
    const Look beside = [](const Vec3& p) { return body_look(p - Vec3{20, 20, 10}); };
    for (const Look& look : {beside, Look([](const Vec3&) { return 0.0; }), Look([](const Vec3& p) { return p.x; })}) {
        const FollowedImage r = follow_image_of(contours, image_of(cube_grid(1.5), look, 8));
        EXPECT_EQ(r.with_image.report.verdict, ImageVerdict::no_help);
        EXPECT_TRUE(std::ranges::equal(r.with_image.fitted.function.weights(), r.plain.function.weights()));
        EXPECT_NE(sentence(r.with_image.report).find("not used"), std::string::npos);
        const std::optional<HeldOutErrors> errors = displaced(contours, image_of(cube_grid(1.5), look, 8));
        ASSERT_TRUE(errors);
        EXPECT_EQ(errors->weight(kTakenBack), 0);
    }
}

TEST(Displace, PlanesThatSeeTheImageShiftedDifferentlyTellItIsNotToBeTrusted) {
    std::vector<Plane> planes;
    for (const double z : {-18.0, 0.0, 18.0}) planes.push_back(make_plane({0, 0, z}, {0, 0, 1}));
    const ContourSet contours = drawn_on(planes);
    const Look shifted = [](const Vec3& p) {
        const double slab = std::floor((p.z + 27) / 18);
        return body_look(p + 6.0 * Vec3{std::cos(2.1 * slab), std::sin(2.1 * slab), 0});
    };
    const FollowedImage r = follow_image_of(contours, image_of(cube_grid(1.5), shifted, 8));
    EXPECT_EQ(r.with_image.report.verdict, ImageVerdict::no_help);
}

TEST(Displace, SaysNothingOfDisplacementsThatVoxelsDoNotShow) {
    const ContourSet contours = drawn_on(three());
    EXPECT_FALSE(displaced(contours, image_of(cube_grid(12), body_look)));
}

TEST(Displace, SaysTheSameForAnyNumberOfThreads) {
    const ContourSet contours = drawn_on(three());
    const Image image = image_of(cube_grid(2), body_look, 8);
    const FollowedImage one = follow_image_of(contours, image, 1), five = follow_image_of(contours, image, 5);
    EXPECT_EQ(one.with_image.report.error_with_mm, five.with_image.report.error_with_mm);
    EXPECT_TRUE(std::ranges::equal(one.with_image.fitted.function.weights(), five.with_image.fitted.function.weights()));
}

}  // namespace
}  // namespace kontur
