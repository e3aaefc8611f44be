// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment_together.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kontur/labels/borrowed_borders.h"
#include "kontur/labels/union_contours.h"
#include "support/coarse_grid.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

/// A sector of a circle in a plane of constant z, its sides drawn `gap` mm off the true ones.
Contour sector(double z, double begin, double end, double radius, double gap) {
    Contour contour;
    contour.plane = {{0, 0, z}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    const double middle = (begin + end) / 2;
    const Vec3 corner = gap / std::sin((end - begin) / 2) * Vec3{std::cos(middle), std::sin(middle), 0} + Vec3{0, 0, z};
    const double turn = std::asin(gap / radius);
    constexpr int kSteps = 30;
    const auto rim = [&](double angle) { return Vec3{radius * std::cos(angle), radius * std::sin(angle), z}; };
    for (int n = 0; n < kSteps; ++n) contour.points.push_back(corner + (n / double(kSteps)) * (rim(begin + turn) - corner));
    for (int n = 0; n <= kSteps; ++n) contour.points.push_back(rim(std::lerp(begin + turn, end - turn, n / double(kSteps))));
    for (int n = 1; n < kSteps; ++n)
        contour.points.push_back(rim(end - turn) + (n / double(kSteps)) * (corner - rim(end - turn)));
    return contour;
}

/// Three sectors of a barrel along z that turn with the height.
std::vector<ContourSet> sectors(double gap) {
    std::vector<ContourSet> sets(3);
    for (int s = 0; s < 3; ++s)
        for (double z = -24; z <= 24; z += 8) {
            const double begin = s * 2 * std::numbers::pi / 3 + 0.02 * z;
            sets[static_cast<std::size_t>(s)].contours.push_back(
                sector(z, begin, begin + 2 * std::numbers::pi / 3, 18 - 0.005 * z * z, gap));
        }
    return sets;
}

Grid grid_here() {
    Grid grid = test::index_grid({44, 44, 49});
    grid.index_to_mm.translation = {-21.5, -21.5, -24};
    return grid;
}

/// Voxels in the barrel, 2 mm within its wall, by how many structures they belong to.
std::array<std::int64_t, 3> counts(const std::vector<Mask>& structures, double step_z) {
    const Grid grid = grid_here();
    std::array<std::int64_t, 3> found{};
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Vec3 p = grid.center_mm(i, j, k);
                if (std::hypot(p.x, p.y) > 16 - 0.005 * p.z * p.z || std::fmod(std::abs(p.z), step_z) != 0) continue;
                std::size_t owners = 0;
                for (const Mask& one : structures) owners += one.values[grid.offset(i, j, k)];
                ++found[std::min<std::size_t>(owners, 2)];
            }
    return found;
}

/// On the whole grid.
std::vector<Mask> masks_of(const Together& together) {
    std::vector<Mask> masks;
    for (std::size_t n = 0; n < together.structures.size(); ++n) masks.push_back(whole_mask(together, n));
    return masks;
}

TEST(SegmentTogether, MakesAPartition) {
    for (const double gap : {0.05, 0.4}) {
        const auto sets = sectors(gap);
        std::vector<Mask> alone;
        for (const ContourSet& set : sets) alone.push_back(segment(set, grid_here()).mask);
        const Together together = segment_together(sets, grid_here());
        const auto before = counts(alone, 1), after = counts(masks_of(together), 1), drawn = counts(masks_of(together), 8);
        EXPECT_GT(before[0] + before[2], 100) << gap;
        EXPECT_EQ(after[2], 0) << gap;
        EXPECT_LE(after[0], before[0] / 5) << gap;
        EXPECT_EQ(drawn[0], 0) << "in drawn slices, " << gap;
        EXPECT_EQ(together.borrowed_points, 0) << "all have drawn everything";
        ASSERT_EQ(together.pairs.size(), 3U);
        for (const StructurePair& pair : together.pairs) EXPECT_EQ(pair.relation, Relation::exclusive);
    }
}

TEST(SegmentTogether, ABorderDrawnOnceCountsForBothNeighbours) {
    constexpr double kTurn = 0.15;  // of the sectors in the plane z = 0 against the others
    auto sets = sectors(0.05);
    for (std::size_t s = 0; s < 3; ++s) {
        const double begin = static_cast<double>(s) * 2 * std::numbers::pi / 3 + kTurn;
        sets[s].contours[3] = sector(0, begin, begin + 2 * std::numbers::pi / 3, 18, 0.05);
    }
    sets[1].contours.erase(sets[1].contours.begin() + 3);
    const Together together = segment_together(sets, grid_here());
    const auto masks = masks_of(together);
    const Grid grid = grid_here();
    int wrong = 0, voxels = 0;
    for (std::int64_t j = 0; j < grid.size.j; ++j)
        for (std::int64_t i = 0; i < grid.size.i; ++i) {
            const Vec3 p = grid.center_mm(i, j, 24);
            if (std::hypot(p.x, p.y) > 16) continue;
            const double angle = std::atan2(p.y, p.x) - kTurn + 4 * std::numbers::pi;
            const auto owner = static_cast<std::size_t>(std::fmod(angle, 2 * std::numbers::pi) / (2 * std::numbers::pi / 3));
            ++voxels, wrong += masks[owner].values[grid.offset(i, j, 24)] == 0;
        }
    EXPECT_LT(wrong, voxels / 100);
    EXPECT_GT(together.borrowed_points, 50);
}

TEST(BorrowedBorders, AreTheSidesThatANeighbourAloneHasDrawn) {
    auto sets = sectors(0.05);
    std::vector<Segmentation> whole;
    for (const ContourSet& set : sets) whole.push_back(segment(set, grid_here()));
    const std::vector<const ContourSet*> drawn{&sets[0], &sets[1], &sets[2]};
    const ContourSet outline = union_contours(drawn, {.step_mm = 0.5, .spacing_mm = 1, .close_mm = 1});
    const Segmentation all = segment(outline, grid_here());
    const Neighbours neighbours{drawn, {&whole[0].function, &whole[1].function, &whole[2].function}, &all.function};
    for (const auto& points : borrowed_borders(neighbours)) EXPECT_TRUE(points.empty()) << "all have drawn everything";
    sets[1].contours.erase(sets[1].contours.begin() + 3);
    const auto borrowed = borrowed_borders(neighbours);
    EXPECT_TRUE(borrowed[0].empty() && borrowed[2].empty());
    EXPECT_GT(borrowed[1].size(), 50U);  // of the two sides of 30 points each
    for (const SurfacePoint& point : borrowed[1]) {
        EXPECT_EQ(point.position.z, 0);
        const double angle = std::atan2(point.position.y, point.position.x), side = 2 * std::numbers::pi / 3;
        EXPECT_LT(std::min(std::abs(angle - side), std::abs(angle + side)) * std::hypot(point.position.x, point.position.y),
                  0.1);
    }
}

/// A straight body and one that bows away from it, drawn on the same planes at their ends and in turns between.
TEST(SegmentTogether, StructuresDrawnInTurnsAreNotMeltedIntoOne) {
    std::vector<ContourSet> sets(2);
    for (int z = -20; z <= 20; z += 2) {
        const bool is_end = std::abs(z) == 20;
        const double bow = 14 * std::cos(std::numbers::pi * z / 40);
        if (is_end || z % 4 == 0)
            sets[0].contours.push_back(test::circle(make_plane({-6, -8, static_cast<double>(z)}, {0, 0, 1}), 6, 40));
        if (is_end || z % 4 != 0)
            sets[1].contours.push_back(test::circle(make_plane({6, -8 + bow, static_cast<double>(z)}, {0, 0, 1}), 6, 40));
    }
    const auto together = masks_of(segment_together(sets, grid_here()));
    for (std::size_t n = 0; n < 2; ++n)
        EXPECT_GT(test::dice(together[n].values, segment(sets[n], grid_here()).mask.values), 0.99) << n;
}

ContourSet ball(const Vec3& center, double radius) { return test::ball_slices(center, radius, 3, 4); }

TEST(SegmentTogether, OneInsideAnotherAndTwoThatOverlapKeepTheirVoxels) {
    const std::vector<ContourSet> nested{ball({0, 0, 0}, 17), ball({4, 0, 0}, 6)};
    const Together inside = segment_together(nested, grid_here());
    ASSERT_EQ(inside.pairs.size(), 1U);
    EXPECT_EQ(inside.pairs[0].relation, Relation::inside);
    for (std::size_t n = 0; n < 2; ++n) EXPECT_EQ(masks_of(inside)[n].values, segment(nested[n], grid_here()).mask.values);
    const std::vector<ContourSet> crossing{ball({-4, 0, 0}, 12), ball({4, 0, 0}, 12)};
    EXPECT_EQ(segment_together(crossing, grid_here()).pairs.at(0).relation, Relation::overlap);
    const Together parted =
        segment_together(crossing, grid_here(), {.segment = {}, .rules = {{1, 0, Relation::exclusive, 0}}});
    EXPECT_EQ(parted.pairs.at(0).relation, Relation::exclusive);
    EXPECT_GT(parted.contested_voxels, 1000);
    // By symmetry the border is the plane x = 0.
    const Grid grid = grid_here();
    const std::vector<Mask> masks = masks_of(parted);
    for (std::int64_t k = 10; k < 39; ++k)
        for (std::int64_t j = 0; j < 44; ++j)
            for (std::int64_t i = 0; i < 44; ++i) {
                const std::size_t n = grid.offset(i, j, k);
                ASSERT_FALSE(masks[0].values[n] && masks[1].values[n]);
                ASSERT_FALSE(grid.center_mm(i, j, k).x > 1 && masks[0].values[n]);
            }
}

TEST(SegmentTogether, ByARuleTheOuterOneGetsWhatTheInnerOneHas) {
    const std::vector<ContourSet> sets{ball({-4, 0, 0}, 12), ball({8, 0, 0}, 6)};
    const Together together = segment_together(sets, grid_here(), {.segment = {}, .rules = {{1, 0, Relation::inside}}});
    const std::vector<Mask> masks = masks_of(together);
    EXPECT_EQ(masks[1].values, segment(sets[1], grid_here()).mask.values);
    const Mask outer = segment(sets[0], grid_here()).mask;
    std::int64_t added = 0;
    for (std::size_t n = 0; n < outer.values.size(); ++n) {
        ASSERT_EQ(masks[0].values[n], outer.values[n] | masks[1].values[n]);
        added += masks[0].values[n] && !outer.values[n];
    }
    EXPECT_GT(added, 50);
    EXPECT_EQ(together.structures[0].report.mask_voxels, std::count(masks[0].values.begin(), masks[0].values.end(), 1));
}

TEST(SegmentTogether, MasksLieOnBoxesAroundTheStructures) {
    Grid wide = test::index_grid({300, 300, 60});
    wide.index_to_mm.translation = {-40, -40, -30};
    const std::vector<ContourSet> sets{ball({0, 0, 0}, 9), ball({200, 200, 0}, 9)};
    const Together together = segment_together(sets, wide);
    EXPECT_TRUE(together.pairs.empty());
    for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_LT(together.structures[n].mask.values.size(), 22U * 22U * 22U);
        EXPECT_EQ(whole_mask(together, n).values, segment(sets[n], wide).mask.values);
    }
}

TEST(SegmentTogether, AnObjectThatReachesBeyondItsFirstBoxIsFoundWhole) {
    ContourSet disc = ball({0, 0, 0}, 12);
    disc.contours.resize(1);  // a cap alone: how far it reaches is a guess
    const Together together = segment_together({&disc, 1}, grid_here());
    EXPECT_EQ(whole_mask(together, 0).values, segment(disc, grid_here()).mask.values);
}

TEST(SegmentTogether, SameBytesForAnyNumberOfThreads) {
    const auto sets = sectors(0.2);
    const Together one = segment_together(sets, grid_here(), {}, {.threads = 1});
    const Together three = segment_together(sets, grid_here(), {}, {.threads = 3});
    for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(one.structures[n].mask.values, three.structures[n].mask.values);
}

TEST(SegmentTogether, RefusesRulesAboutStructuresThatAreNotThere) {
    const std::vector<ContourSet> one{ball({0, 0, 0}, 10)};
    EXPECT_KONTUR_ERROR(segment_together(one, grid_here(), {.segment = {}, .rules = {{0, 1, Relation::overlap, 0}}}),
                        ErrorKind::invalid_input, "the structures 0 and 1; there are 1");
    EXPECT_KONTUR_ERROR(segment_together({}, grid_here()), ErrorKind::invalid_input, "there are 0 structures");
}

TEST(UnionContours, OfTwoHalvesIsTheWhole) {
    const auto sets = sectors(0.2);
    const std::array<const ContourSet*, 3> structures{&sets[0], &sets[1], &sets[2]};
    const ContourSet outline = union_contours(structures, {.step_mm = 0.5, .close_mm = 1});
    ASSERT_EQ(outline.contours.size(), 7U);
    for (const Contour& contour : outline.contours)
        for (const Vec3& p : contour.points) EXPECT_NEAR(std::hypot(p.x, p.y), 18 - 0.005 * p.z * p.z, 0.75);
}

TEST(UnionContours, PointsAreAsFarApartAsAskedFor) {
    const auto sets = sectors(0.2);
    const std::array<const ContourSet*, 3> structures{&sets[0], &sets[1], &sets[2]};
    const ContourSet dense = union_contours(structures, {.step_mm = 0.5, .close_mm = 1});
    const ContourSet sparse = union_contours(structures, {.step_mm = 0.5, .spacing_mm = 3, .close_mm = 1});
    EXPECT_LT(5 * point_count(sparse), point_count(dense));
    for (const Contour& contour : sparse.contours)
        for (std::size_t n = 1; n < contour.points.size(); ++n)
            EXPECT_LT(distance(contour.points[n - 1], contour.points[n]), 3.8);
}

TEST(UnionContours, LeavesOutPlanesThatShowSomeOnly) {
    auto sets = sectors(0.2);
    sets[1].contours.erase(sets[1].contours.begin() + 3);
    sets[2].contours.pop_back();  // at its end, beyond which it does not reach
    const std::array<const ContourSet*, 3> structures{&sets[0], &sets[1], &sets[2]};
    EXPECT_EQ(union_contours(structures).contours.size() > 0, true);
    for (const Contour& contour : union_contours(structures).contours) EXPECT_NE(contour.plane.origin.z, 0);
}

}  // namespace
}  // namespace kontur
