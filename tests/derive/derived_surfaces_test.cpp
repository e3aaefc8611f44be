// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/derived_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kontur/derive/derive.h"
#include "kontur/derive/levels.h"
#include "kontur/extract/mesh_mask.h"
#include "kontur/segment.h"
#include "solid_levels.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

ContourSet circles_of_a_ball() {
    constexpr double kRadius = 20;
    ContourSet set;
    for (int axis = 0; axis < 3; ++axis)
        for (const double at : {-7.0, 9.0}) {
            Vec3 normal{}, origin{};
            normal[axis] = 1;
            origin[axis] = at;
            set.contours.push_back(test::circle(make_plane(origin, normal), std::sqrt(kRadius * kRadius - at * at), 60));
        }
    return set;
}

/// A ball of some 20 mm as it was drawn, on a grid.
struct DrawnBall {
    Grid grid = test::grid_of({1, 1, 2.5}, 0.17, 42);
    Segmentation made = segment(circles_of_a_ball(), grid, {.mesh = true});

    NamedStructure for_files() const { return {"A", made.mask, made.function}; }
    ShownStructure for_screens() const { return {"A", std::make_shared<const TriangleMesh>(*made.mesh), made.function}; }
};

double ml(const TriangleMesh& mesh) { return signed_volume_mm3(mesh) / 1000; }

double differing_share(const Mask& a, const Mask& b) {
    double differing = 0, inside = 0;
    for (std::size_t n = 0; n < a.values.size(); ++n) differing += a.values[n] != b.values[n], inside += a.values[n];
    return differing / inside;
}

const std::vector<std::string> kRules{"P = A + 5 mm", "Ring = P - (A + 2 mm)", "S = clip(A - 3 mm, superior 0 mm)"};

TEST(DerivedSurfaces, EncloseTheVoxelsThatDeriveMakes) {
    const DrawnBall ball;
    const auto masks = derive(kRules, std::array{ball.for_files()});
    const auto meshes = derived_surfaces(kRules, std::array{ball.for_screens()}, {ball.grid});
    ASSERT_EQ(meshes.size(), 3u);
    for (std::size_t n = 0; n < 3; ++n) {
        const MeshTopology topology = kontur::topology(meshes[n]);
        EXPECT_TRUE(topology.closed && topology.oriented) << kRules[n];
        EXPECT_EQ(meshes[n].normals.size(), meshes[n].points.size());
        EXPECT_LT(differing_share(masks[n].mask, voxelize_mesh(meshes[n], ball.grid).mask), 0.002) << kRules[n];
    }
}

TEST(DerivedSurfaces, OnLargerVoxelsAreNearlyTheSame) {
    const DrawnBall ball;
    const auto fine = derived_surfaces(kRules, std::array{ball.for_screens()}, {ball.grid});
    const auto coarse = derived_surfaces(kRules, std::array{ball.for_screens()}, {ball.grid, 60'000});
    for (std::size_t n = 0; n < 3; ++n) {
        EXPECT_LT(coarse[n].triangles.size(), fine[n].triangles.size());
        EXPECT_NEAR(ml(coarse[n]) / ml(fine[n]), 1, 0.04) << kRules[n];
    }
}

TEST(DerivedSurfaces, MayBeOfTheBody) {
    const DrawnBall ball;
    const auto body = std::make_shared<const Mask>(test::mask_of(test::ball(30), ball.grid));
    int asked = 0;
    DerivedSurfacesOptions options{ball.grid};
    options.body = [&](const std::optional<double>&) { return ++asked, body; };
    const auto made =
        derived_surfaces(std::vector<std::string>{"Skin = body() - (body() - 3 mm)", "In = crop(A + 8 mm, body(), 2 mm)"},
                         std::array{ball.for_screens()}, options);
    EXPECT_EQ(asked, 3);
    const auto shell = [](double out, double in) { return 4 * M_PI / 3 * (out * out * out - in * in * in) / 1000; };
    EXPECT_NEAR(ml(made[0]) / shell(30, 27), 1, 0.05);
    EXPECT_NEAR(ml(made[1]) / shell(28, 0), 1, 0.03) << "the ball of 20 mm ends 2 mm below the body's surface";
}

TEST(DerivedSurfaces, NothingLeftHasNoTriangles) {
    const DrawnBall ball;
    EXPECT_TRUE(derived_surfaces(std::vector<std::string>{"X = A - A"}, std::array{ball.for_screens()}, {ball.grid})
                    .front()
                    .triangles.empty());
}

}  // namespace
}  // namespace kontur
