// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/shared_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kontur/labels/boxed_mask.h"
#include "kontur/labels/filled_map.h"
#include "kontur/segment.h"
#include "support/contour_sets.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

Grid grid_here(bool mirrored = false) {
    Grid grid = test::index_grid({48, 40, 40});
    grid.index_to_mm.translation = {-24.2, -19.6, -19.4};
    if (mirrored) {
        grid.index_to_mm.set_column(0, {-1, 0, 0});
        grid.index_to_mm.translation.x = 22.8;
    }
    return grid;
}

ContourSet ball(const Vec3& center, double radius) { return test::ball_slices(center, radius, 2, 3); }

/// Two balls that are cut where they touch, the plane x = 0, and one inside the first.
struct Case {
    Grid grid;
    std::vector<BoxedMask> objects;
    std::vector<ImplicitFunction> functions;
    SharedSurface surface;
};

Case balls(bool mirrored = false) {
    Case made{grid_here(mirrored), {}, {}, {}};
    for (const auto& [center, radius] :
         {std::pair{Vec3{-8, 0, 0}, 12.0}, std::pair{Vec3{8, 0, 0}, 12.0}, std::pair{Vec3{-9, 1, 0}, 4.0}}) {
        Segmentation one = segment(ball(center, radius), made.grid);
        for (std::size_t n = 0; n < one.mask.values.size(); ++n) {
            const auto m = static_cast<std::int64_t>(n);
            const double x = made.grid.center_mm(m % 48, m / 48 % 40, m / 1920).x;
            if (radius > 10 && x * center.x < 0) one.mask.values[n] = 0;
        }
        made.objects.push_back(trimmed({{{0, 0, 0}, {47, 39, 39}}, std::move(one.mask)}, made.grid));
        made.functions.push_back(one.function);
    }
    made.surface = shared_surface(made.objects, made.functions, made.grid);
    return made;
}

TEST(SharedSurface, EachObjectsSurfaceIsClosedAndEnclosesItsVolume) {
    for (const bool mirrored : {false, true}) {
        const Case made = balls(mirrored);
        for (std::size_t object = 0; object < 3; ++object) {
            const TriangleMesh mesh = surface_of(made.surface, object);
            const MeshTopology shape = topology(mesh);
            EXPECT_TRUE(shape.closed && shape.oriented) << object;
            EXPECT_EQ(shape.euler, 2) << object;
            const auto voxels =
                std::count(made.objects[object].mask.values.begin(), made.objects[object].mask.values.end(), 1);
            EXPECT_NEAR(signed_volume_mm3(mesh) / static_cast<double>(voxels), 1, 0.04) << object;
        }
    }
}

TEST(SharedSurface, WhereTwoTouchTheyShareTrianglesOnTheBorder) {
    const Case made = balls();
    std::size_t shared = 0;
    for (std::size_t n = 0; n < made.surface.sides.size(); ++n) {
        const auto& [behind, front] = made.surface.sides[n];
        if (made.surface.regions[behind].empty() || made.surface.regions[front].empty()) continue;
        if (made.surface.regions[behind].size() + made.surface.regions[front].size() > 2) continue;  // of the inner one
        ++shared;
        for (const std::uint32_t corner : made.surface.mesh.triangles[n]) {
            const Vec3& p = made.surface.mesh.points[corner];
            if (std::hypot(p.y, p.z) > 8) continue;
            EXPECT_NEAR(p.x, 0, 0.1);  // by symmetry
        }
    }
    EXPECT_GT(shared, 200U);
    EXPECT_EQ(made.surface.regions.size(), 4U);  // nothing, the two, and the inner one in the first
}

TEST(SharedSurface, NoPointIsThereTwice) {
    const Case made = balls();
    std::set<std::array<double, 3>> points;
    for (const Vec3& p : made.surface.mesh.points) EXPECT_TRUE(points.insert({p.x, p.y, p.z}).second);
    std::vector<bool> is_used(made.surface.mesh.points.size());
    for (const auto& triangle : made.surface.mesh.triangles)
        for (const std::uint32_t corner : triangle) is_used[corner] = true;
    EXPECT_TRUE(std::all_of(is_used.begin(), is_used.end(), [](bool used) { return used; }));
}

TEST(SharedSurface, PointsLieWhereTheFunctionIsZero) {
    const Case made = balls();
    for (const std::size_t object : {1, 2}) {
        std::vector<Vec3> points = surface_of(made.surface, object).points;
        std::erase_if(points, [&](const Vec3& p) { return object == 1 && p.x < 2; });
        for (const double depth : depths_mm(made.functions[object], points, {.threads = 1}))
            EXPECT_NEAR(depth, 0, 0.02) << object;
    }
}

TEST(SharedSurface, VoxelsThatMeetByAnEdgeStayClosed) {
    const Grid grid = test::index_grid({6, 6, 6});
    BoxedMask object{{{0, 0, 0}, {5, 5, 5}}, {grid, std::vector<std::uint8_t>(216)}};
    object.set({2, 2, 2}, true), object.set({3, 3, 2}, true), object.set({0, 0, 0}, true);
    const Segmentation any = segment(ball({2.5, 2.5, 2.5}, 8), grid);
    const std::vector<ImplicitFunction> functions{any.function};
    const TriangleMesh mesh = surface_of(shared_surface({&object, 1}, functions, grid), 0);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const auto& triangle : mesh.triangles)
        for (std::size_t n = 0; n < 3; ++n) {
            const std::uint32_t a = triangle[n], b = triangle[(n + 1) % 3];
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    for (const auto& [edge, sum] : balance) EXPECT_EQ(sum, 0);
    EXPECT_GT(signed_volume_mm3(mesh), 0.1);
}

TEST(SharedSurface, OfNothingIsEmpty) { EXPECT_TRUE(shared_surface({}, {}, grid_here()).mesh.triangles.empty()); }

}  // namespace
}  // namespace kontur
