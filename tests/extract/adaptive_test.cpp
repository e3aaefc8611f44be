// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/adaptive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kontur/extract/polygonize.h"
#include "kontur/extract/voxelize.h"
#include "kontur/fit/fit.h"
#include "kontur/measure/components.h"
#include "support/expect_error.h"
#include "support/functions.h"
#include "support/random.h"

namespace kontur {
namespace {

const Vec3 kCenter{20, -30, 100};

struct Agreement {
    std::int64_t inside = 0;     ///< of either mask
    std::int64_t different = 0;  ///< of one mask only
    double evaluations = 0;      ///< as a fraction of track_surface's

    double jaccard() const {
        return 1 - static_cast<double>(different) / static_cast<double>(std::max<std::int64_t>(inside, 1));
    }
};

Agreement compare(const ImplicitFunction& function, const Grid& grid, const std::vector<Vec3>& starts) {
    const SurfaceLattice tracked = track_surface(function, grid, starts, {.threads = 2});
    const SurfaceLattice adaptive = track_surface_adaptively(function, grid, starts, {.threads = 2});
    const Mask a = fill(tracked), b = fill(adaptive);
    Agreement result{0, 0, static_cast<double>(adaptive.evaluations) / static_cast<double>(tracked.evaluations)};
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        result.inside += a.values[i] || b.values[i];
        result.different += a.values[i] != b.values[i];
    }
    return result;
}

/// A closed curve on a body, where a plane cuts it: found along rays from the plane's origin, which lies inside.
Contour cut(const Plane& plane, int count, const auto& is_inside) {
    Contour contour{plane, {}, true, false};
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * i / count;
        double low = 0, high = 200;
        while (high - low > 1e-9) {
            const double middle = (low + high) / 2;
            (is_inside(plane.from_uv(middle * std::cos(angle), middle * std::sin(angle))) ? low : high) = middle;
        }
        contour.points.push_back(plane.from_uv(low * std::cos(angle), low * std::sin(angle)));
    }
    return contour;
}

std::vector<Vec3> points_of(const ContourSet& set) {
    std::vector<Vec3> points;
    for (const Contour& contour : set.contours) points.insert(points.end(), contour.points.begin(), contour.points.end());
    return points;
}

/// Contours of a bumpy body in oblique planes that cross each other.
ContourSet crossing_contours(int points_each) {
    const auto is_inside = [](const Vec3& p) {
        const Vec3 d = p - kCenter, n = normalized(d);
        return norm(d) < 22 + 3 * std::sin(4 * n.x) * std::cos(3 * n.y) + 2 * n.z;
    };
    ContourSet set;
    for (const Vec3& normal : {Vec3{0.2, 0.1, 1}, {1, 0.3, -0.2}, {0.1, 1, 0.3}, {1, -1, 0.5}, {-0.3, 0.8, 1}})
        for (const double shift : {-9.0, 0.0, 8.0})
            set.contours.push_back(cut(make_plane(kCenter + shift * normalized(normal), normal), points_each, is_inside));
    return set;
}

const ImplicitFunction& crossing_function() {
    static const ImplicitFunction function = [] {
        const ContourSet set = crossing_contours(60);
        FitOptions options;
        options.normal_offset_mm = 0.2;
        options.solve.smoothing = 1e-5;
        return fit(prepare(set), options).function;
    }();
    return function;
}

TEST(Adaptive, AgreesWithTrackingOnAnalyticBodiesOnEveryKindOfGrid) {
    const Grid plain = test::grid_about(kCenter, {90, 94, 98}, 0.5);
    for (const Affine3& change : {Affine3{}, test::kOblique, test::kSheared, test::kMirrored}) {
        const Grid grid = test::changed(plain, change);
        const Agreement ball = compare(test::ball_function(kCenter, 15.3), grid,
                                       {kCenter + Vec3{15.3, 0, 0}, kCenter - Vec3{0, 15.3, 0}, kCenter - Vec3{0, 0, 15.3}});
        EXPECT_EQ(ball.different, 0);
        EXPECT_GT(ball.inside, 80000);
        EXPECT_LT(ball.evaluations, 0.3);
        const ImplicitFunction spheroid = test::spheroid_function(kCenter, {6, 4, 2}, 11);
        const Agreement oblong = compare(spheroid, grid,
                                         {kCenter + 11 / std::sqrt(56) * Vec3{6, 4, 2},
                                          kCenter - 11 / std::sqrt(56) * Vec3{6, 4, 2}, kCenter + Vec3{0, 0, 8}});
        EXPECT_GE(oblong.jaccard(), 0.9999);
        EXPECT_GT(oblong.inside, 15000);
    }
}

TEST(Adaptive, AgreesWithTrackingOnCrossingObliqueContours) {
    const std::vector<Vec3> starts = points_of(crossing_contours(60));
    for (const Affine3& change : {Affine3{}, test::kSheared, test::kMirrored}) {
        const Agreement found =
            compare(crossing_function(), test::changed(test::grid_about(kCenter, {110, 112, 108}, 0.5), change), starts);
        EXPECT_GT(found.inside, 200000);
        EXPECT_GE(found.jaccard(), 0.9999);
        EXPECT_LT(found.evaluations, 0.5);
    }
}

TEST(Adaptive, AgreesWithTrackingOnThickSlices) {
    Grid grid = test::grid_about(kCenter, {110, 110, 12}, 0.5);
    grid.index_to_mm.linear[2][2] = 5;
    grid.index_to_mm.translation.z = kCenter.z - 27;
    const Agreement found = compare(crossing_function(), grid, points_of(crossing_contours(60)));
    EXPECT_GT(found.inside, 20000);
    EXPECT_GE(found.jaccard(), 0.9999);
    EXPECT_LT(found.evaluations, 0.7);
}

TEST(Adaptive, LeavesSmallObjectsAndGridsToTracking) {
    const ImplicitFunction ball = test::ball_function({}, 4);
    const std::vector<Vec3> starts{{4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {-4, 0, 0}};
    for (const Index3& size : {Index3{200, 200, 200}, {30, 30, 30}, {100, 1, 1}, {1, 1, 1}}) {
        const Agreement found = compare(ball, test::grid_about({}, size, 1), starts);
        EXPECT_EQ(found.different, 0);
        EXPECT_TRUE(found.evaluations == 1 || size.i == 1);
    }
    EXPECT_TRUE(track_surface_adaptively(ball, test::grid_about({}, {50, 50, 50}, 1), {}, {.threads = 1}).cells.empty());
}

TEST(Adaptive, FindsObjectsBetweenThePointsOfTheCoarseLattice) {
    // A rod of one voxel's radius, a plate of 1.6 voxels' thickness, and small balls far from each other.
    const Grid grid = test::grid_about({}, {100, 100, 100}, 1);
    const double focus = 40, half_axis = std::hypot(40, 1);
    const Vec3 along = normalized({1, 0.6, 0.3});
    std::vector<Vec3> rod_starts;
    for (int i = -18; i <= 18; ++i) {
        const double t = 2.2 * i;
        rod_starts.push_back(t * along + std::sqrt(1 - t * t / (half_axis * half_axis)) * any_perpendicular(along));
    }
    const Agreement rod = compare(test::spheroid_function({}, focus * along, half_axis), grid, rod_starts);
    EXPECT_GT(rod.inside, 100);
    EXPECT_EQ(rod.different, 0);

    TriangleMesh plate = test::unit_sphere(4);
    for (std::size_t i = 0; i < plate.points.size(); ++i) {
        const Vec3 d = plate.points[i];
        plate.points[i] = {30 * d.x, 30 * d.y, 0.8 * d.z};
        plate.normals[i] = normalized({d.x / 30, d.y / 30, d.z / 0.8});
    }
    const Agreement thin = compare(test::function_through(plate, 0.2), grid, plate.points);
    EXPECT_GT(thin.inside, 2000);
    EXPECT_GE(thin.jaccard(), 0.999);

    TriangleMesh balls;
    for (const Vec3& center : {Vec3{-30, 1, 2}, {30, 0, 0}, {0, 33, -5}, {3, -30, 20}}) {
        const TriangleMesh ball = test::ball(center, 1.3, 2);
        balls.points.insert(balls.points.end(), ball.points.begin(), ball.points.end());
        balls.normals.insert(balls.normals.end(), ball.normals.begin(), ball.normals.end());
    }
    const ImplicitFunction function = test::function_through(balls, 0.3);
    EXPECT_EQ(compare(function, grid, balls.points).different, 0);
    EXPECT_EQ(component_sizes(fill(track_surface_adaptively(function, grid, balls.points, {.threads = 2}))).size(), 4u);
}

TEST(Adaptive, ClosesObjectsCutOffAtTheGridsBorderWithoutMoreValues) {
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 center{}, start{};
            center[axis] = side * 40;
            start[axis] = side * 10;
            std::vector<Vec3> starts{start};
            for (int other = 0; other < 3; ++other)
                if (other != axis) {
                    starts.push_back(center);
                    starts.back()[other] += 30;
                    starts.push_back(center);
                    starts.back()[other] -= 30;
                }
            const Agreement found = compare(test::ball_function(center, 30), test::grid_about({}, {80, 81, 82}, 1), starts);
            EXPECT_EQ(found.different, 0);
            EXPECT_GT(found.inside, 40000);
            EXPECT_LT(found.evaluations, 0.3);
        }
    // The whole grid is inside.
    const Agreement full = compare(test::ball_function({}, 80), test::grid_about({}, {41, 42, 43}, 1),
                                   {{-20, 0, 0}, {20, 0, 0}, {0, -20, 0}, {0, 20, 0}, {0, 0, 20}, {0, 0, -21}});
    EXPECT_EQ(full.different, 0);
}

TEST(Adaptive, FindsTheComponentsThatStartsTouchAndNoOther) {
    TriangleMesh both = test::ball({-22, 0, 0}, 14, 3);
    const TriangleMesh second = test::ball({20, 3, 0}, 12, 3);
    both.points.insert(both.points.end(), second.points.begin(), second.points.end());
    both.normals.insert(both.normals.end(), second.normals.begin(), second.normals.end());
    const ImplicitFunction function = test::function_through(both);
    const Grid grid = test::grid_about({}, {100, 60, 60}, 1);
    const std::vector<Vec3> first(both.points.begin(),
                                  both.points.end() - static_cast<std::ptrdiff_t>(second.points.size()));
    for (const auto& starts : {first, second.points, both.points}) {
        EXPECT_GE(compare(function, grid, starts).jaccard(), 0.9999);
        EXPECT_EQ(component_sizes(fill(track_surface_adaptively(function, grid, starts, {.threads = 2}))).size(),
                  starts.size() == both.points.size() ? 2u : 1u);
    }
}

TEST(Adaptive, FollowsALeakToTheGridsEnd) {
    const ImplicitFunction half_space(Kernel::triharmonic, {{}, 1}, {}, {}, {0.3, 0.1, 0.2, 1});
    const std::vector<Vec3> starts{{0, 0, -0.3}, {25, 0, -2.8}, {0, 25, -5.3}, {-25, -25, 7.2}};
    const Grid grid = test::grid_about({}, {70, 70, 70}, 1);
    const Agreement found = compare(half_space, grid, starts);
    EXPECT_EQ(found.different, 0);
    EXPECT_NEAR(static_cast<double>(found.inside), 35.3 * 70 * 70, 2000);
}

TEST(Adaptive, AgreesWithTrackingOnRoughFunctionsOfManySheets) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> anywhere(0, 60);
    Agreement all;
    for (int round = 0; round < 8; ++round) {
        const ImplicitFunction function = test::rough_function(60, random);
        const Grid grid =
            test::changed(test::grid_about({30, 30, 30}, {61, 58, 64}, 1), round % 2 ? test::kSheared : Affine3{});
        std::vector<Vec3> starts;
        for (int i = 0; i < 40; ++i) starts.push_back({anywhere(random), anywhere(random), anywhere(random)});
        const Agreement found = compare(function, grid, starts);
        all.inside += found.inside;
        all.different += found.different;
    }
    EXPECT_GE(all.jaccard(), 0.999);
    EXPECT_GT(all.inside, 100000);
}

TEST(Adaptive, ValuesGrowWithTheSurfaceAndAreAFractionOfTracking) {
    const std::vector<Vec3> starts = points_of(crossing_contours(60));
    const auto evaluations = [&](double spacing) {
        const auto n = static_cast<std::int64_t>(60 / spacing);
        return static_cast<double>(track_surface_adaptively(crossing_function(),
                                                            test::grid_about(kCenter, {n, n, n}, spacing), starts,
                                                            {.threads = 0})
                                       .evaluations);
    };
    const double fine = evaluations(0.25);
    EXPECT_LT(fine, 4.4 * evaluations(0.5));
    EXPECT_LT(compare(crossing_function(), test::grid_about(kCenter, {240, 240, 240}, 0.25), starts).evaluations, 0.3);
}

TEST(Adaptive, LeavesDoubtsCloseToTheSurfaceOnly) {
    const std::vector<Vec3> starts = points_of(crossing_contours(60));
    const Grid grid = test::grid_about(kCenter, {110, 112, 108}, 0.5);
    FastFunction function(crossing_function(), {.tolerance_mm = 0.01, .expected_points = 1'000'000});
    const SurfaceLattice resolved = track_surface_adaptively(function, grid, starts);
    const SurfaceLattice rough = track_surface_adaptively(function, grid, starts, {}, Doubts::left);
    EXPECT_LT(rough.evaluations, 0.8 * static_cast<double>(resolved.evaluations));
    const Mask a = fill(resolved), b = fill(rough);
    int different = 0;
    for (std::size_t n = 0; n < a.values.size(); ++n) {
        if (a.values[n] == b.values[n]) continue;
        ++different;
        const auto at = static_cast<std::int64_t>(n);
        const Vec3 p = grid.center_mm(at % grid.size.i, at / grid.size.i % grid.size.j, at / grid.size.i / grid.size.j);
        EXPECT_LT(std::abs(crossing_function().value(p)), 0.25) << "half a voxel";
    }
    EXPECT_LT(different, 2000) << "of 60,000 on the surface";
}

TEST(ExpectedSurfaceVoxels, AreAboutThoseThatManySmallBallsPass) {
    constexpr int kSide = 120, kPitch = 12, kPointsOfBall = 60;
    constexpr double kRadius = 3;
    const auto inside = [](int i, int j, int k) {
        const auto off = [](int at) { return at % kPitch - 5.7; };
        return std::hypot(off(i), off(j), off(k)) < kRadius;
    };
    std::int64_t passed = 0;
    for (int k = 0; k + 1 < kSide; ++k)
        for (int j = 0; j + 1 < kSide; ++j)
            for (int i = 0; i + 1 < kSide; ++i) {
                int corners = 0;
                for (int n = 0; n < 8; ++n) corners += inside(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
                passed += corners > 0 && corners < 8;
            }
    std::vector<Vec3> starts;
    for (int ball = 0; ball < 1000; ++ball)
        for (int n = 0; n < kPointsOfBall; ++n) {  // on a spiral from pole to pole
            const double z = 1 - (2 * n + 1.0) / kPointsOfBall, turn = 2.4 * n, r = std::sqrt(1 - z * z);
            const Vec3 center{ball % 10 * kPitch + 5.7, ball / 10 % 10 * kPitch + 5.7, ball / 100 * kPitch + 5.7};
            starts.push_back(center + kRadius * Vec3{r * std::cos(turn), r * std::sin(turn), z});
        }
    const auto expected = static_cast<double>(expected_surface_voxels(Grid{{kSide, kSide, kSide}, {}}, starts));
    EXPECT_GT(expected, 0.5 * static_cast<double>(passed));
    EXPECT_LT(expected, 2.0 * static_cast<double>(passed));
}

TEST(Adaptive, MeshIsClosedAndLiesOnTheSurface) {
    const Grid grid = test::changed(test::grid_about(kCenter, {110, 112, 108}, 0.5), test::kMirrored);
    const SurfaceLattice surface =
        track_surface_adaptively(crossing_function(), grid, points_of(crossing_contours(60)), {.threads = 2});
    const TriangleMesh mesh = polygonize(surface, crossing_function());
    const MeshTopology found = topology(mesh);
    EXPECT_TRUE(found.closed && found.oriented);
    EXPECT_EQ(found.euler, 2);
    for (std::size_t i = 0; i < mesh.points.size(); i += 7)
        EXPECT_LT(std::abs(crossing_function().value(mesh.points[i])), 0.05);
}

TEST(Adaptive, SameBytesForAnyNumberOfThreads) {
    const std::vector<Vec3> starts = points_of(crossing_contours(60));
    const Grid grid = test::grid_about(kCenter, {110, 112, 108}, 0.5);
    const auto run = [&](int threads) {
        return track_surface_adaptively(crossing_function(), grid, starts, {.threads = threads});
    };
    const SurfaceLattice one = run(1);
    for (const int threads : {2, 5}) {
        const SurfaceLattice many = run(threads);
        EXPECT_EQ(many.cells, one.cells);
        EXPECT_EQ(many.evaluations, one.evaluations);
        for (const Index3& cell : one.cells) ASSERT_EQ(many.lattice.corners(cell), one.lattice.corners(cell));
    }
}

TEST(Adaptive, ReportsProgressAndStopsWhenAskedTo) {
    const std::vector<Vec3> starts = points_of(crossing_contours(60));
    const Grid grid = test::grid_about(kCenter, {110, 112, 108}, 0.5);
    double last = 0;
    StopSource source;
    int reports = 0;
    const Work work{2,
                    [&](std::string_view stage, double done) {
                        EXPECT_EQ(stage, "voxelize");
                        EXPECT_GE(done, last);
                        EXPECT_LE(done, 1);
                        last = done;
                        ++reports;
                    },
                    source.token()};
    track_surface_adaptively(crossing_function(), grid, starts, work);
    EXPECT_GT(reports, 2);
    source.request_stop();
    last = 0;
    EXPECT_KONTUR_ERROR(track_surface_adaptively(crossing_function(), grid, starts, work), ErrorKind::cancelled, "");
}

}  // namespace
}  // namespace kontur
