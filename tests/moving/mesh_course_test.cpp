// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/mesh_course.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "kontur/segment_moving.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

constexpr int kFrames = 10;

/// A ball of 30 mm in frame 1 and of 20 mm, a little beside it, in frame 6.
ContourSet two_balls() {
    ContourSet set = test::ball_slices({0, 0, 0}, 30, 6, 9);
    for (Contour& contour : set.contours) contour.frame = 1;
    ContourSet small = test::ball_slices({4, 0, 0}, 20, 6, 6);
    for (Contour& contour : small.contours) {
        contour.frame = 6;
        set.contours.push_back(contour);
    }
    set.cycle_frames = kFrames;
    return set;
}

Grid grid() { return grid_around({{-36, -36, -36}, {36, 36, 36}}, {2, 2, 2}, 0); }

std::vector<double> all_frames() {
    std::vector<double> frames;
    for (int n = 1; n <= kFrames; ++n) frames.push_back(n);
    return frames;
}

const MovingFit& fit() {
    static const MovingFit made = MovingFitter(grid()).fit(two_balls(), all_frames());
    return made;
}

std::vector<std::vector<Vec3>> starts() { return fit().starts(); }

const MeshCourse& course() {
    static const MeshCourse made(fit().function, starts(), 1.5);
    return made;
}

/// Each edge belongs to two triangles that run along it in opposite directions.
void expect_closed(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t n = 0; n < 3; ++n) ++edges[{t[n], t[(n + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_TRUE(edges.contains({edge.second, edge.first}));
    }
}

TEST(MeshCourse, SurfacesAreClosedAndLieWhereTheFunctionVanishes) {
    for (const double time : {1.0, 1.7, 3.0, 4.4, 6.0, 8.2, 10.9}) {
        const TriangleMesh mesh = course().at(time);
        ASSERT_FALSE(mesh.triangles.empty()) << time;
        expect_closed(mesh);
        double sum = 0, most = 0, cosine = 1;
        for (std::size_t n = 0; n < mesh.points.size(); ++n) {
            const double off = std::abs(fit().function.value(mesh.points[n], time));
            sum += off;
            most = std::max(most, off);
            const Vec3 step = 0.05 * mesh.normals[n];
            const double rise =
                fit().function.value(mesh.points[n] - step, time) - fit().function.value(mesh.points[n] + step, time);
            cosine = std::min(cosine, rise);
        }
        EXPECT_LT(sum / static_cast<double>(mesh.points.size()), 0.03) << time;
        EXPECT_LT(most, 0.3) << time;
        EXPECT_GT(cosine, 0) << "normals lead out, at " << time;
    }
}

TEST(MeshCourse, VolumesAreThoseOfTheMasks) {
    const std::vector<double> times = all_frames();
    const MovingSegmentation masks = segment_moving(two_balls(), grid(), times);
    for (std::size_t n = 0; n < times.size(); ++n)
        EXPECT_NEAR(signed_volume_mm3(course().at(times[n])) / 1000, masks.volumes.volumes_ml[n],
                    0.02 * masks.volumes.volumes_ml[n])
            << times[n];
}

TEST(MeshCourse, ACycleHasNoSeamAndThreadsDoNotMatter) {
    EXPECT_EQ(course().at(1).points, course().at(1 + kFrames).points);
    const MeshCourse alone(fit().function, starts(), 1.5, {.threads = 1});
    EXPECT_EQ(alone.at(3.3).points, course().at(3.3).points);
    EXPECT_EQ(alone.at(3.3).triangles, course().at(3.3).triangles);
}

TEST(MeshCourse, ALatticeOfTooManyPointsIsCoarser) {
    const MeshCourse coarse(fit().function, starts(), 0.1);
    EXPECT_GT(coarse.spacing_mm(), 0.3);
    EXPECT_FALSE(coarse.at(2).triangles.empty());
}

TEST(MeshCourse, WhatItIsMadeOfIsChecked) {
    EXPECT_KONTUR_ERROR(MeshCourse(fit().function, {}, 1), ErrorKind::invalid_input, "there are starts of 0 moments");
    EXPECT_KONTUR_ERROR(MeshCourse(fit().function, {{}, {}}, 1), ErrorKind::invalid_input, "no finite point");
    EXPECT_KONTUR_ERROR(MaskCourse(fit().function, {}), ErrorKind::invalid_input, "there are 0 masks of 2 moments");
}

TEST(MovingFitter, AMomentThatStaysIsNotFittedAgainAndAllIsAsOfASingleFit) {
    MovingFitter fitter(grid());
    ContourSet set = two_balls();
    fitter.fit(set, all_frames());
    for (Vec3& p : set.contours.back().points) p += Vec3{0.5, 0, 0};
    const MovingFit again = fitter.fit(set, all_frames()), alone = MovingFitter(grid()).fit(set, all_frames());
    ASSERT_EQ(again.moments.size(), 2);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(again.moments[k].segmentation.mask.values, alone.moments[k].segmentation.mask.values);
        EXPECT_EQ(again.moments[k].time, alone.moments[k].time);
        EXPECT_EQ(again.moments[k].contours, alone.moments[k].contours);
    }
    const Vec3 at{12, 3, 4};
    EXPECT_EQ(again.function.value(at, 2.5), alone.function.value(at, 2.5));
}

TEST(MeshCourse, ChangesAlongItsSurfacesAreThoseOfTheFunction) {
    for (const double time : {1.0, 2.5, 5.0, 9.0}) {
        const std::vector<Vec3> points = course().at(time).points;
        const std::vector<double> changes = course().changes(points, time);
        const std::vector<double> of_function = fit().function.changes(points, time);
        for (std::size_t n = 0; n < points.size(); ++n)
            ASSERT_NEAR(changes[n], of_function[n], 0.05 + 0.02 * of_function[n]) << time << " " << n;
    }
    EXPECT_EQ(course().changes({{0, 0, 1000}}, 3), std::vector<double>{0}) << "far from all that is known";
}

}  // namespace
}  // namespace kontur
