// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/measure/components.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/functions.h"

namespace kontur {
namespace {

constexpr double kRadius = 20;
const Vec3 kCenter{20, -30, 100};

using test::ball_contours;

Grid ball_grid() { return test::grid_about(kCenter, {26, 27, 28}, 2); }

ContourSet moved(ContourSet set, const Affine3& motion) {
    for (Contour& contour : set.contours) {
        for (Vec3& p : contour.points) p = motion.apply(p);
        contour.plane.origin = motion.apply(contour.plane.origin);
        for (Vec3* axis : {&contour.plane.normal, &contour.plane.u, &contour.plane.v}) *axis = motion.apply_linear(*axis);
    }
    return set;
}

std::int64_t inside_count(const Mask& mask) { return std::count(mask.values.begin(), mask.values.end(), 1); }

bool warns(const SegmentReport& report, const std::string& part) {
    return std::ranges::any_of(report.warnings, [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

TEST(Segment, BallFromItsCircles) {
    const Segmentation result = segment(ball_contours(), ball_grid());
    const double volume = 4.0 / 3 * M_PI * std::pow(kRadius, 3) / 1000;
    EXPECT_NEAR(result.report.mask_volume_ml, volume, 0.01 * volume);
    EXPECT_TRUE(result.report.warnings.empty()) << result.report.warnings.front();
    for (std::int64_t k = 0; k < 28; ++k)
        for (std::int64_t j = 0; j < 27; ++j)
            for (std::int64_t i = 0; i < 26; ++i) {
                const double depth = kRadius - distance(result.mask.grid.center_mm(i, j, k), kCenter);
                if (std::abs(depth) < 0.3) continue;
                ASSERT_EQ(result.mask.values[result.mask.grid.offset(i, j, k)], depth > 0);
            }
}

TEST(Segment, SaysWhereContoursContradictEachOther) {
    ContourSet contours = ball_contours();
    for (Vec3& p : contours.contours[0].points)
        p = contours.contours[0].plane.origin + 1.3 * (p - contours.contours[0].plane.origin);
    const Segmentation result = segment(contours, ball_grid());
    EXPECT_TRUE(warns(result.report, "contradict")) << "a circle that is 5.6 mm too large";
    ASSERT_FALSE(result.report.crossings.empty());
    const Crossing& worst = result.report.crossings.front();
    EXPECT_TRUE(worst.contour == 0 || worst.other == 0);
    EXPECT_NEAR(worst.disagreement_mm, 5.6, 0.3);
    EXPECT_FALSE(warns(segment(ball_contours(), ball_grid()).report, "contradict"));
}

TEST(Segment, ReportSaysWhatWasDone) {
    const ContourSet contours = ball_contours();
    for (const Normals normals : {Normals::surface, Normals::in_plane}) {
        SegmentOptions options;
        options.normals = normals;
        options.mesh = true;
        const Segmentation result = segment(contours, ball_grid(), options);
        const SegmentReport& report = result.report;
        EXPECT_EQ(report.contours, 6u);
        EXPECT_EQ(report.points, 360u);
        EXPECT_EQ(report.constraints, report.centres);
        EXPECT_EQ(report.centres, result.function.weights().size());
        const std::size_t all = 2u * 360u + report.bounded;
        if (normals == Normals::in_plane) EXPECT_EQ(report.constraints + report.merged, all);
        else EXPECT_EQ(report.constraints + report.merged, all / 3) << "every third point tells where a circle runs";
        EXPECT_EQ(report.normals, normals);
        EXPECT_EQ(report.solver, Solver::iterative);
        EXPECT_EQ(report.solves, normals == Normals::surface ? 3 : 1);
        EXPECT_GE(report.iterations, report.solves);
        EXPECT_NEAR(report.normal_offset_mm, (normals == Normals::surface ? 1.35e-2 : 4.5e-3) * diameter_mm(contours),
                    1e-12);
        EXPECT_EQ(report.smoothing, normals == Normals::surface ? 1e-5 : 0);
        const Residual measured = residual(result.function, contours);
        EXPECT_EQ(report.residual.max_mm, measured.max_mm);
        EXPECT_EQ(report.residual.rms_mm, measured.rms_mm);
        EXPECT_LT(report.residual.max_mm, 0.1);
        EXPECT_EQ(report.mask_voxels, inside_count(result.mask));
        EXPECT_EQ(report.mask_components, static_cast<std::int64_t>(component_sizes(result.mask).size()));
        EXPECT_NEAR(report.mask_volume_ml, static_cast<double>(report.mask_voxels) * 8 / 1000, 1e-12);
        EXPECT_GT(report.surface_voxels, 0);
        EXPECT_LT(report.evaluations, ball_grid().voxel_count());
        std::vector<std::string> stages;
        for (const auto& [stage, seconds] : report.seconds) {
            stages.push_back(stage);
            EXPECT_GE(seconds, 0);
        }
        EXPECT_EQ(stages, (std::vector<std::string>{"prepare", "fit", "voxelize", "polygonize", "check", "measure"}));
        ASSERT_TRUE(result.mesh);
        EXPECT_TRUE(topology(*result.mesh).closed);
        EXPECT_NEAR(signed_volume_mm3(*result.mesh) / 1000, report.mask_volume_ml, 0.02 * report.mask_volume_ml);
    }
}

TEST(Segment, SameBytesForAnyNumberOfThreads) {
    for (const Solver solver : {Solver::iterative, Solver::cholesky, Solver::dense}) {
        SegmentOptions options;
        options.solver = solver;
        options.mesh = true;
        const Segmentation one = segment(ball_contours(), ball_grid(), options, {.threads = 1});
        for (const int threads : {2, 4}) {
            const Segmentation many = segment(ball_contours(), ball_grid(), options, {.threads = threads});
            EXPECT_TRUE(std::ranges::equal(many.function.weights(), one.function.weights()));
            EXPECT_TRUE(many.mask.values == one.mask.values);
            EXPECT_EQ(many.mesh->points, one.mesh->points);
            EXPECT_EQ(many.mesh->normals, one.mesh->normals);
            EXPECT_EQ(many.mesh->triangles, one.mesh->triangles);
        }
    }
}

TEST(Segment, MovesWithItsPatient) {
    ContourSet egg = ball_contours();
    for (Contour& contour : egg.contours) {
        contour.plane.origin.x += 5;
        for (Vec3& p : contour.points) p.x += 5 + 1e-3 * (p.z - kCenter.z) * (p.z - kCenter.z);
    }
    std::erase_if(egg.contours, [](const Contour& c) { return std::abs(c.plane.normal.x) > 0.5; });  // bent by that
    const Mask here = segment(egg, ball_grid()).mask;
    Affine3 motion = test::kOblique;
    motion.translation = {900, -500, 1200};
    Grid grid = ball_grid();
    grid.index_to_mm = compose(motion, grid.index_to_mm);
    const Mask there = segment(moved(egg, motion), grid).mask;
    std::int64_t different = 0;
    for (std::size_t i = 0; i < here.values.size(); ++i) different += here.values[i] != there.values[i];
    EXPECT_GT(inside_count(here), 3000);
    EXPECT_LE(different, 6);
}

TEST(Segment, InteriorAndExteriorPointsGetTheirSide) {
    ContourSet set = ball_contours();
    const Vec3 dent = kCenter + Vec3{13, 13, 3}, bump = kCenter + Vec3{-14, -14, -8};  // just inside, just outside
    ASSERT_LT(distance(dent, kCenter), kRadius - 0.5);
    ASSERT_GT(distance(bump, kCenter), kRadius + 0.5);
    set.exterior = {dent};
    set.interior = {bump};
    const ImplicitFunction without = segment(ball_contours(), ball_grid()).function;
    const ImplicitFunction with = segment(set, ball_grid()).function;
    EXPECT_GT(without.value(dent), 0);
    EXPECT_LT(without.value(bump), 0);
    EXPECT_LT(with.value(dent), 0);
    EXPECT_GT(with.value(bump), 0);
}

TEST(Segment, WhatIsSupposedInAnEmptyPlaneDisappearsAndContoursStay) {
    ContourSet set;
    for (const double z : {-12.0, -4.0, 4.0})
        set.contours.push_back(test::circle(make_plane(kCenter + Vec3{0, 0, z}, {0, 0, 1}), 15, 60));
    const Plane empty = make_plane(kCenter + Vec3{0, 0, 8}, {0, 0.1, 1});
    const auto most_in = [&](const Segmentation& made, double least) {
        double most = -1e9;
        for (double x = -30; x <= 30; x += 1.5)
            for (double y = -30; y <= 30; y += 1.5)
                for (double z = least; z <= 0; z += 1)
                    most = std::max(most, made.function.value(empty.from_uv(x, y) - z * empty.normal));
        return most;
    };
    const Segmentation without = segment(set, ball_grid());
    ASSERT_GT(most_in(without, 0), 0) << "there would be nothing to take away";
    set.empty_planes = {empty};
    const Segmentation with = segment(set, ball_grid());
    EXPECT_LT(most_in(with, -15), 0) << "nor does anything go on behind it";
    EXPECT_LT(with.report.residual.max_mm, 0.5);
    EXPECT_LT(with.report.mask_voxels, without.report.mask_voxels);
    EXPECT_EQ(with.report.mask_components, 1);
    EXPECT_FALSE(warns(with.report, "nothing is seen"));

    set.empty_planes = {make_plane(kCenter + Vec3{0, 0, 4}, {0, 0, 1})};
    const Segmentation contradicted = segment(set, ball_grid());
    EXPECT_EQ(contradicted.mask.values, without.mask.values);
    EXPECT_TRUE(warns(contradicted.report, "contradicted by contour 3"));
}

TEST(Segment, SingleCircleIsAClosedBody) {
    const Plane plane = make_plane(kCenter, {0.3, -0.5, 0.8});
    ContourSet set;
    set.contours = {test::circle(plane, 15, 60)};
    for (const Normals normals : {Normals::surface, Normals::in_plane}) {
        SegmentOptions options;
        options.normals = normals;
        options.mesh = true;
        const Segmentation result = segment(set, test::grid_about(kCenter, {60, 60, 60}, 1), options);
        EXPECT_TRUE(warns(result.report, "one plane"));
        EXPECT_EQ(result.report.mask_components, 1);
        EXPECT_FALSE(warns(result.report, "border"));
        EXPECT_TRUE(topology(*result.mesh).closed);
        EXPECT_LT(result.report.residual.max_mm, 0.2);
        if (normals == Normals::in_plane) continue;
        const double ball = 4.0 / 3 * M_PI * std::pow(15, 3);
        EXPECT_NEAR(static_cast<double>(result.report.mask_voxels), ball, 0.1 * ball) << "about as thick as it is wide";
    }
}

TEST(Segment, CoplanarContoursAreABodyWithAHole) {
    const Plane plane = make_plane(kCenter, {0.3, -0.5, 0.8});
    ContourSet set;
    set.contours = {test::circle(plane, 20, 80), test::circle(plane, 8, 40)};
    set.contours[1].hole = true;
    const Segmentation result = segment(set, test::grid_about(kCenter, {60, 60, 60}, 1));
    EXPECT_TRUE(warns(result.report, "one plane"));
    EXPECT_FALSE(warns(result.report, "border"));
    EXPECT_EQ(result.report.mask_components, 1);
    EXPECT_LT(result.function.value(kCenter), 0);
    EXPECT_GT(result.function.value(kCenter + 14 * plane.u), 0);
}

TEST(Segment, WarnsOfWhatTheUserShouldKnow) {
    EXPECT_TRUE(warns(segment(ball_contours(), test::grid_about(kCenter, {15, 30, 30}, 2)).report, "border"));
    ContourSet repeated = ball_contours();
    repeated.contours[2].points.insert(repeated.contours[2].points.begin() + 5, repeated.contours[2].points[5]);
    EXPECT_TRUE(warns(segment(repeated, ball_grid()).report, "1 repeated point was left out"));
    ContourSet tiny;
    for (int i = 0; i < 3; ++i)
        tiny.contours.push_back(test::circle(make_plane(kCenter + Vec3{0, 1, 0.03 * i}, {0, 0, 1}), 0.3, 30));
    EXPECT_TRUE(warns(segment(tiny, ball_grid()).report, "empty"));
}

TEST(Segment, RefusesInputThatCannotBeSegmented) {
    const auto refused = [](ErrorKind kind, const std::string& part, const auto& change) {
        ContourSet contours = ball_contours();
        Grid grid = ball_grid();
        SegmentOptions options;
        change(contours, grid, options);
        EXPECT_KONTUR_ERROR(segment(contours, grid, options), kind, part);
    };
    using enum ErrorKind;
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    refused(invalid_input, "", [](ContourSet& c, Grid&, SegmentOptions&) { c.contours.clear(); });
    refused(invalid_input, "contour 2", [](ContourSet& c, Grid&, SegmentOptions&) { c.contours[1].points.resize(2); });
    refused(invalid_input, "contour 3", [&](ContourSet& c, Grid&, SegmentOptions&) { c.contours[2].points[4].x = nan; });
    refused(invalid_input, "off its plane",
            [](ContourSet& c, Grid&, SegmentOptions&) { c.contours[0].points[7] += c.contours[0].plane.normal; });
    refused(invalid_input, "no area", [](ContourSet& c, Grid&, SegmentOptions&) {
        c.contours.resize(1);
        for (std::size_t i = 0; i < 60; ++i)
            c.contours[0].points[i] = c.contours[0].plane.origin + static_cast<double>(i) * c.contours[0].plane.u;
    });
    refused(invalid_input, "", [&](ContourSet& c, Grid&, SegmentOptions&) { c.interior = {{nan, 0, 0}}; });
    refused(invalid_input, "", [](ContourSet&, Grid& g, SegmentOptions&) { g.index_to_mm.translation.x += 1e4; });
    refused(invalid_input, "voxels", [](ContourSet&, Grid& g, SegmentOptions&) { g.size.j = 0; });
    refused(invalid_input, "axes", [](ContourSet&, Grid& g, SegmentOptions&) { g.index_to_mm.set_column(1, {}); });
    refused(too_large, "voxels", [](ContourSet&, Grid& g, SegmentOptions&) { g.size = {1 << 20, 1 << 20, 1 << 20}; });
    for (const double bad : {0.0, -1.0, nan, infinity})
        refused(invalid_input, "offset", [&](ContourSet&, Grid&, SegmentOptions& o) { o.normal_offset_mm = bad; });
    for (const double bad : {0.0, -0.5, 1.5, nan})
        refused(invalid_input, "quality", [&](ContourSet&, Grid&, SegmentOptions& o) { o.quality = bad; });
    for (const double bad : {-1.0, nan, infinity})
        refused(invalid_input, "smoothing", [&](ContourSet&, Grid&, SegmentOptions& o) { o.smoothing = bad; });
    for (const double bad : {0.0, -1.0, nan, infinity})
        refused(invalid_input, "tolerance", [&](ContourSet&, Grid&, SegmentOptions& o) { o.tolerance_mm = bad; });
    refused(invalid_input, "tolerance is -1 mm", [](ContourSet&, Grid&, SegmentOptions& o) { o.tolerance_mm = -1; });
}

TEST(Segment, StopsAtWhicheverReportItIsAskedTo) {
    const ContourSet contours = ball_contours();
    SegmentOptions options;
    options.mesh = true;
    std::vector<std::pair<std::string, double>> reports;
    segment(contours, ball_grid(), options,
            {.callback = [&](std::string_view stage, double done) { reports.emplace_back(stage, done); }});
    ASSERT_GT(reports.size(), 8u);
    for (const auto& [stage, done] : reports) {
        EXPECT_GE(done, 0) << stage;
        EXPECT_LE(done, 1) << stage;
    }
    for (std::size_t stop_at = 1; stop_at <= reports.size(); stop_at += stop_at < 3 ? 1 : reports.size() / 5) {
        StopSource source;
        std::size_t count = 0;
        const Work work{.callback =
                            [&](std::string_view, double) {
                                if (++count == stop_at) source.request_stop();
                            },
                        .stop = source.token()};
        EXPECT_KONTUR_ERROR(segment(contours, ball_grid(), options, work), ErrorKind::cancelled, "cancelled");
        EXPECT_EQ(count, stop_at);
    }
}

}  // namespace
}  // namespace kontur
