// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/margin.h"

#include <gtest/gtest.h>

#include "kontur/derive/mask_levels.h"
#include "solid_levels.h"

namespace kontur {
namespace {

using test::Solid;

SideLengths everywhere(double mm) { return {mm, mm, mm, mm, mm, mm}; }

Levels moved(const Levels& levels, const WorkLattice& lattice, double by) {
    return margin(levels, lattice.grid, everywhere(std::abs(by)), by > 0 ? MarginSide::outwards : MarginSide::inwards,
                  {.threads = 2});
}

/// How far from the exact surface a voxel lies at most that is on the wrong side, in lengths of a voxel across the surface.
double worst_side(const Levels& found, const Solid& solid, const WorkLattice& lattice, const Grid& image, double by) {
    const Index3 steps = steps_per_voxel(lattice);
    double worst = 0;
    for (std::int64_t k = 0; k < image.size.k; ++k)
        for (std::int64_t j = 0; j < image.size.j; ++j)
            for (std::int64_t i = 0; i < image.size.i; ++i) {
                const Vec3 p = image.center_mm(i, j, k);
                const float level = found.at({i * steps.i, j * steps.j, k * steps.k});
                if (std::abs(level) > 2 && (i + j + k) % 16 != 0) continue;  // an exact level takes long
                const double exact = solid.level(p) + by;
                const bool inside = level > 0;
                if (inside != (exact > 0)) worst = std::max(worst, std::abs(exact) / test::voxel_length(solid, image, p));
            }
    return worst;
}

bool is_smooth(const Solid& solid) { return solid.name == "ball" || solid.name == "ellipsoid"; }

TEST(Margin, OfSmoothBodiesIsWrongByLessThanAThirdOfAVoxel) {
    for (const Vec3& spacing : test::spacings())
        for (const double tilt : test::tilts())
            for (const Solid& solid : test::solids())
                for (const double by : {3.0, -3.0}) {
                    if (!is_smooth(solid)) continue;
                    const Grid image = test::grid_of(spacing, tilt, 22);
                    const WorkLattice lattice = work_lattice(image);
                    EXPECT_LT(worst_side(moved(test::levels_of(solid, lattice), lattice, by), solid, lattice, image, by),
                              0.3)
                        << solid.name << ' ' << spacing.z << ' ' << tilt << ' ' << by;
                }
}

TEST(Margin, AtSharpEdgesIsWrongByLessThanAVoxel) {
    for (const Vec3& spacing : test::spacings())
        for (const double tilt : test::tilts())
            for (const Solid& solid : test::solids()) {
                if (is_smooth(solid)) continue;
                const Grid image = test::grid_of(spacing, tilt, 22);
                const WorkLattice lattice = work_lattice(image);
                EXPECT_LT(worst_side(moved(test::levels_of(solid, lattice), lattice, 5), solid, lattice, image, 5), 1.0)
                    << solid.name << ' ' << spacing.z << ' ' << tilt;
            }
}

TEST(Margin, OfMasksOfSmoothBodiesIsWrongByLessThanHalfAVoxel) {
    for (const Vec3& spacing : test::spacings())
        for (const double tilt : test::tilts())
            for (const Solid& solid : test::solids())
                for (const double by : {5.0, -3.0}) {
                    if (!is_smooth(solid)) continue;
                    const Grid image = test::grid_of(spacing, tilt, 22);
                    const WorkLattice lattice = work_lattice(image);
                    const Levels levels = mask_levels(test::mask_of(solid, image), lattice, {.threads = 2});
                    EXPECT_LT(worst_side(moved(levels, lattice, by), solid, lattice, image, by), 0.5)
                        << solid.name << ' ' << spacing.z << ' ' << tilt << ' ' << by;
                }
}

TEST(Margin, OfAMaskOfWholeVoxelsIsExactBesideItsFaces) {
    // A box of whole voxels is its own mask: beside its faces a margin ends where it should, voxel for voxel.
    Grid image{{40, 40, 30}, {}};
    image.index_to_mm.set_column(2, {0, 0, 1.3});
    Mask box{image, std::vector<std::uint8_t>(static_cast<std::size_t>(image.voxel_count()))};
    for (std::int64_t k = 10; k < 20; ++k)
        for (std::int64_t j = 12; j < 28; ++j)
            for (std::int64_t i = 12; i < 28; ++i) box.values[image.offset(i, j, k)] = 1;
    const WorkLattice lattice = work_lattice(image);
    const Levels grown = moved(mask_levels(box, lattice, {}), lattice, 4.2),
                 shrunk = moved(mask_levels(box, lattice, {}), lattice, -4.2);
    for (std::int64_t n = 0; n < 40; ++n) {
        EXPECT_EQ(grown.at({n, 20, 15}) > 0, n >= 8 && n < 32) << n;  // 11.5 - 4.2 = 7.3
        EXPECT_EQ(shrunk.at({20, n, 15}) > 0, n >= 16 && n < 24) << n;
        EXPECT_EQ(grown.at({20, 20, n}) > 0, n >= 7 && n < 23) << n;  // 9.5 - 4.2 / 1.3 = 6.3
        EXPECT_EQ(shrunk.at({20, 20, n}) > 0, n >= 13 && n < 17) << n;
    }
}

/// How far a body with these half axes reaches along a unit vector.
double reach_of(const SideLengths& lengths, const Vec3& u) {
    return norm({u.x * (u.x > 0 ? lengths.left : lengths.right), u.y * (u.y > 0 ? lengths.posterior : lengths.anterior),
                 u.z * (u.z > 0 ? lengths.superior : lengths.inferior)});
}

TEST(Margin, ReachesAsFarAsItsLengthInEachOfSixDirections) {
    const SideLengths lengths{.left = 6, .right = 3, .anterior = 8, .posterior = 3, .superior = 7, .inferior = 4};
    for (const Vec3& spacing : test::spacings())
        for (const double tilt : test::tilts())
            for (const Solid& solid : test::solids())
                for (const SideLengths& one : {everywhere(5), lengths}) {
                    const Grid image = test::grid_of(spacing, tilt, 22);
                    const WorkLattice lattice = work_lattice(image);
                    const std::vector<Vec3> points = surface_points(
                        margin(test::levels_of(solid, lattice), lattice.grid, one, MarginSide::outwards, {.threads = 2}),
                        lattice.grid);
                    for (int direction = 0; direction < 6; ++direction) {
                        Vec3 u;
                        u[direction / 2] = direction % 2 ? 1 : -1;
                        double found = -1e9, squared = 0;
                        for (const Vec3& p : points) found = std::max(found, dot(p, u));
                        for (int axis = 0; axis < 3; ++axis) squared += std::pow(dot(u, image.index_to_mm.column(axis)), 2);
                        EXPECT_LT(std::abs(found - solid.support(u) - reach_of(one, u)) / std::sqrt(squared), 0.3)
                            << solid.name << ' ' << spacing.z << ' ' << tilt << ' ' << direction << ' ' << one.are_alike();
                    }
                }
}

TEST(Margin, GrowsOnlyTowardsTheSidesThatHaveALength) {
    const Solid solid = test::box("box", {8, 8, 8});
    for (const double tilt : {0.0, 0.17}) {
        const Grid image = test::grid_of({1, 1, 1}, tilt, 20);
        const WorkLattice lattice = work_lattice(image);
        const Levels levels = test::levels_of(solid, lattice);
        const SideLengths left{.left = 6};
        const Levels grown = margin(levels, image, left, MarginSide::outwards, {}),
                     shrunk = margin(levels, image, left, MarginSide::inwards, {});
        for (std::int64_t k = 0; k < image.size.k; ++k)
            for (std::int64_t j = 0; j < image.size.j; ++j)
                for (std::int64_t i = 0; i < image.size.i; ++i) {
                    const Vec3 p = image.center_mm(i, j, k);
                    const double outer = test::box_level(p - Vec3{3, 0, 0}, {11, 8, 8}),
                                 inner = test::box_level(p + Vec3{3, 0, 0}, {5, 8, 8});
                    if (std::abs(outer) > 0.9) {
                        EXPECT_EQ(grown.at({i, j, k}) > 0, outer > 0) << p.x << ' ' << p.y << ' ' << p.z;
                    }
                    if (std::abs(inner) > 0.9) {
                        EXPECT_EQ(shrunk.at({i, j, k}) > 0, inner > 0) << p.x << ' ' << p.y << ' ' << p.z;
                    }
                }
    }
}

}  // namespace
}  // namespace kontur
