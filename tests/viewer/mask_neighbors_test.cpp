// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/mask_neighbors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kontur/correct/put_label.h"
#include "viewer/files/structure_exports.h"
#include "viewer/model/model.h"
#include "viewer/surfaces/surfaces.h"

namespace kontur::viewer {
namespace {

const Grid kGrid{{40, 40, 40}, {}};

/// What lies within 12 of the middle, from one x to another.
Mask slab(double from, double to) {
    Mask mask{kGrid, {}};
    for (std::int64_t n = 0; n < kGrid.voxel_count(); ++n) {
        const Index3 v = index_at(static_cast<std::size_t>(n), kGrid.size);
        const Vec3 p = kGrid.center_mm(v.i, v.j, v.k);
        mask.values.push_back(norm(p - Vec3{20, 20, 20}) < 12 && p.x >= from && p.x < to);
    }
    return mask;
}

/// A circle of 6 mm around a place in the middle slice is all of the mask there.
ContourSet circle_at(double x) {
    const Plane plane{{x, 20, 20}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    Contour circle{plane, {}};
    for (int n = 0; n < 60; ++n) circle.points.push_back(plane.from_uv(6 * std::cos(0.1047 * n), 6 * std::sin(0.1047 * n)));
    ContourSet set;
    set.contours = {circle};
    return set;
}

struct Halves {
    Mask left = slab(0, 19.5), right = slab(19.5, 40);
    CorrectedMask corrected = correct(left, {circle_at(14), {}});
    std::shared_ptr<const MaskExchange> exchange =
        std::make_shared<const MaskExchange>(exchange_of(left, made_voxels(corrected)));
};

TEST(MaskNeighbors, AMaskFollowsAsALabelOfAMapDoes) {
    const Halves halves;
    Image labels{kGrid, std::vector<std::uint8_t>(halves.left.values.size())};
    auto& values = std::get<std::vector<std::uint8_t>>(labels.samples);
    for (std::size_t n = 0; n < values.size(); ++n)
        values[n] = halves.left.values[n] ? 1 : static_cast<std::uint8_t>(2 * halves.right.values[n]);
    const Image put = put_label(labels, {1, halves.left, halves.corrected.mask}, true).labels;
    const CorrectedMask after = after_others(correct(halves.right, {}), StoredMask(halves.right), {halves.exchange});
    EXPECT_NE(after.mask.values, halves.right.values);
    EXPECT_EQ(after.mask.values, select_mask(put, 2, "labels").values);
    EXPECT_LT(after.report.dice, 1);
    EXPECT_DOUBLE_EQ(after.report.volume_ml,
                     static_cast<double>(std::ranges::count(after.mask.values, 1)) * kGrid.voxel_volume_mm3() / 1000);
}

TEST(MaskNeighbors, OneThatOverlapsOrHasAnotherGridDoesNotShare) {
    const StoredMask left(slab(0, 19.5)), right(slab(19.5, 40)), both(slab(18, 40)), far(slab(30, 40));
    EXPECT_TRUE(may_share(left, right));
    EXPECT_FALSE(may_share(left, both));
    EXPECT_FALSE(may_share(right, both));
    EXPECT_TRUE(boxes_touch(left, right));
    EXPECT_FALSE(boxes_touch(left, far));
    Mask moved = slab(19.5, 40);
    moved.grid.index_to_mm.translation.x = 0.5;
    EXPECT_FALSE(may_share(left, StoredMask(moved)));
    const BorderRule exclusive{1, 2, Relation::exclusive}, overlap{1, 2, Relation::overlap};
    EXPECT_TRUE(may_share(&exclusive, left, both));
    EXPECT_FALSE(may_share(&overlap, left, right));
}

TEST(MaskNeighbors, WhatWasCorrectedAndWhatIsTakenCountMore) {
    const StoredMask right(slab(19.5, 40));
    const std::size_t own = kGrid.offset(21, 20, 20), beside = kGrid.offset(19, 20, 20);
    const auto gives = std::make_shared<const MaskExchange>(MaskExchange{{{beside, own}}, {}});
    const auto takes = std::make_shared<const MaskExchange>(MaskExchange{{}, {beside, own}});
    ASSERT_EQ(followed_voxels(right, {gives}).size(), 1U);
    EXPECT_EQ(followed_voxels(right, {gives}).front().how, CorrectedVoxel::added_carried);
    for (const MaskExchanges& both : {MaskExchanges{gives, takes}, MaskExchanges{takes, gives}}) {
        const std::vector<MadeVoxel> followed = followed_voxels(right, both);
        ASSERT_EQ(followed.size(), 1U);
        EXPECT_EQ(followed.front().offset, own);
        EXPECT_EQ(followed.front().how, CorrectedVoxel::removed_carried);
    }
    const std::vector<MadeVoxel> all = made_and_followed({{own, CorrectedVoxel::removed_drawn}}, right, {takes});
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all.front().how, CorrectedVoxel::removed_drawn);
    MaskExchange keeps;
    keeps.kept = std::make_shared<const StoredMask>(slab(0, 19.5));
    const MaskExchanges locked{std::make_shared<const MaskExchange>(keeps)};
    EXPECT_TRUE(made_and_followed({{beside, CorrectedVoxel::added_drawn}}, right, locked).empty()) << "a locked mask's";
    EXPECT_EQ(made_and_followed({{own, CorrectedVoxel::removed_drawn}}, right, locked).size(), 1U);
}

/// A project with both, the first of them corrected.
State project_of(const Halves& halves, bool shared) {
    State state;
    state.use_image = false;
    state.borders.shared = shared;
    Id id = 0;
    for (const Mask* mask : {&halves.left, &halves.right}) {
        const auto stored = std::make_shared<const StoredMask>(*mask);
        state.masks[stored->hash()] = stored;
        Structure one;
        one.id = ++id;
        one.mask = StructureMask{.hash = stored->hash()};
        state.structures[id] = one;
    }
    DrawnContour line = as_drawn(circle_at(14).contours.front());
    line.id = 3;
    line.structure = 1;
    state.contours[line.id] = std::make_shared<const DrawnContour>(line);
    return state;
}

TEST(MaskNeighbors, FilesHoldTheMaskThatFollows) {
    const Halves halves;
    const Image image{kGrid, std::vector<std::int16_t>(halves.left.values.size())};
    const CorrectedMask expected = after_others(correct(halves.right, {}), StoredMask(halves.right), {halves.exchange});
    const State state = project_of(halves, true);
    const std::vector<FittedStructure> all = fit_structures(state, image, true, {});
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].segmentation.mask.values, halves.corrected.mask.values);
    EXPECT_EQ(all[1].segmentation.mask.values, expected.mask.values);
    EXPECT_EQ(all[1].corrected->origin, expected.origin);
    EXPECT_EQ(fit_structure(state, 2, image, false, {}).segmentation.mask.values, expected.mask.values) << "by itself, too";
    const double ml = signed_volume_mm3(*all[1].segmentation.mesh) / 1000;
    EXPECT_NEAR(ml, expected.report.volume_ml, 0.05 * ml);
    const State apart = project_of(halves, false);
    EXPECT_EQ(fit_structures(apart, image, false, {})[1].segmentation.mask.values, halves.right.values);
    EXPECT_EQ(fit_structure(apart, 2, image, false, {}).segmentation.mask.values, halves.right.values);
}

/// Two masks in the page's surfaces.
struct SharedSurfaces {
    Halves halves;
    std::shared_ptr<const StoredMask> left = std::make_shared<const StoredMask>(halves.left);
    std::shared_ptr<const StoredMask> right = std::make_shared<const StoredMask>(halves.right);
    Surfaces surfaces{{[](Id, std::int64_t, const PlaneCutters&) {}, [](std::shared_ptr<const Surface>) {},
                       [](const std::string&, std::optional<double>) {}}};

    void follow(Id id, ContourSet set) {
        SurfaceTask task;
        task.structure = id;
        task.mask = id == 1 ? left : right;
        for (std::size_t n = 0; n < set.contours.size(); ++n) task.ids.push_back(static_cast<Id>(10 * id) + 1);
        task.set = std::move(set);
        surfaces.follow(std::move(task));
        surfaces.wait();
    }
    double ml(Id id) { return surfaces.all().at(id)->volume_ml; }
    std::int64_t followed(Id id) { return surfaces.all().at(id)->corrected->followed; }
};

double ml_of(const Mask& mask) {
    return static_cast<double>(std::ranges::count(mask.values, 1)) * mask.grid.voxel_volume_mm3() / 1000;
}

TEST(MaskNeighbors, InThePageItFollowsAtOnceAndComesBack) {
    SharedSurfaces page;
    page.follow(1, {});
    page.follow(2, {});
    page.surfaces.share_borders({.shared = true});
    page.follow(1, circle_at(14));
    const CorrectedMask expected = after_others(correct(page.halves.right, {}), *page.right, {page.halves.exchange});
    EXPECT_GT(page.followed(2), 0);
    EXPECT_DOUBLE_EQ(page.ml(2), expected.report.volume_ml);
    EXPECT_NEAR(signed_volume_mm3(*page.surfaces.all().at(2)->mesh) / 1000, page.ml(2), 0.05 * page.ml(2));
    EXPECT_EQ(page.surfaces.all().at(2)->stage, SurfaceStage::finished);
    page.surfaces.share_borders({});
    page.surfaces.wait();
    EXPECT_DOUBLE_EQ(page.ml(2), ml_of(page.halves.right)) << "they share none any more";
    page.surfaces.share_borders({.shared = true});
    page.surfaces.wait();
    EXPECT_DOUBLE_EQ(page.ml(2), expected.report.volume_ml) << "they do again";
    page.surfaces.share_borders({.shared = true, .rules = {{1, 2, Relation::overlap}}});
    page.surfaces.wait();
    EXPECT_EQ(page.followed(2), 0) << "they may overlap";
    page.surfaces.share_borders({.shared = true});
    page.surfaces.wait();
    page.follow(1, {});
    EXPECT_EQ(page.followed(2), 0) << "the correction was taken back";
    EXPECT_DOUBLE_EQ(page.ml(2), ml_of(page.halves.right));
}

TEST(MaskNeighbors, ALockedOneStaysAndItsBorderIsKept) {
    SharedSurfaces page;
    page.surfaces.share_borders({.shared = true});
    page.follow(1, circle_at(14));
    page.follow(2, {});
    const double followed = page.ml(2);
    EXPECT_GT(page.followed(2), 0);
    const CorrectedMask locked = after_others(correct(page.halves.right, {}), *page.right, {page.halves.exchange});
    SurfaceTask task;
    task.structure = 2;
    task.mask = page.right;
    task.kept = std::make_shared<const StoredMask>(locked.mask);
    page.surfaces.follow(task);
    page.surfaces.wait();
    EXPECT_DOUBLE_EQ(page.ml(2), followed);
    page.follow(1, {});
    EXPECT_DOUBLE_EQ(page.ml(2), followed) << "its neighbour's correction is gone, and it stays";
    EXPECT_LT(page.ml(1), ml_of(page.halves.left)) << "what it got from the neighbour it keeps";
    page.follow(1, circle_at(22));  // far into the locked one
    EXPECT_DOUBLE_EQ(page.ml(2), followed);
    page.surfaces.share_borders({});
    page.surfaces.wait();
    EXPECT_DOUBLE_EQ(page.ml(2), followed) << "where borders are not shared, too";
}

TEST(MaskNeighbors, FilesHoldALockedMaskAsItWas) {
    const Halves halves;
    const Image image{kGrid, std::vector<std::int16_t>(halves.left.values.size())};
    const CorrectedMask expected = after_others(correct(halves.right, {}), StoredMask(halves.right), {halves.exchange});
    State state = project_of(halves, true);
    const auto kept = std::make_shared<const StoredMask>(expected.mask);
    state.masks[kept->hash()] = kept;
    state.structures.at(2).mask->kept = kept->hash();
    for (const double x : {14.0, 22.0, 0.0}) {
        state.contours.clear();
        if (x > 0) {
            DrawnContour line = as_drawn(circle_at(x).contours.front());
            line.id = 3;
            line.structure = 1;
            state.contours[line.id] = std::make_shared<const DrawnContour>(line);
        }
        const std::vector<FittedStructure> all = fit_structures(state, image, false, {});
        EXPECT_EQ(all[1].segmentation.mask.values, expected.mask.values) << x;
        EXPECT_EQ(all[1].corrected->origin, expected.origin) << x;
        for (std::size_t n = 0; n < expected.mask.values.size(); ++n)
            ASSERT_FALSE(all[0].segmentation.mask.values[n] && expected.mask.values[n]) << x << ": " << n;
    }
}

TEST(MaskNeighbors, TwoThatFollowEachOtherComeToAnEnd) {
    SharedSurfaces page;
    page.surfaces.share_borders({.shared = true});
    page.follow(1, circle_at(14));
    page.follow(2, circle_at(26));
    EXPECT_GT(page.followed(1), 0);
    EXPECT_GT(page.followed(2), 0);
    SurfaceTask gone;
    gone.structure = 1;
    page.surfaces.follow(gone);
    page.surfaces.wait();
    EXPECT_EQ(page.followed(2), 0) << "it was removed";
}

}  // namespace
}  // namespace kontur::viewer
