// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct_mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "kontur/base/error.h"
#include "kontur/correct/corrected_voxels.h"
#include "kontur/extract/trace.h"
#include "kontur/measure/components.h"
#include "kontur/shape/index_box.h"
#include "support/mask_of.h"

namespace kontur {
namespace {

using Inside = std::function<bool(const Vec3&)>;

Grid grid_of(const Vec3& spacing, double half_mm, double shear = 0) {
    Grid grid{{}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step;
        step[axis] = spacing[axis];
        if (axis == 2) step.y = shear * spacing.z;
        grid.index_to_mm.set_column(axis, step);
        grid.size[axis] = static_cast<std::int64_t>(std::ceil(2 * half_mm / spacing[axis])) + 1;
        grid.index_to_mm.translation[axis] = -half_mm;
    }
    return grid;
}

Inside ball(const Vec3& center, double radius) {
    return [=](const Vec3& p) { return distance(p, center) < radius; };
}

Contour circle(const Plane& plane, double radius, double from = 0, double to = 2 * std::numbers::pi, int points = 120) {
    Contour contour{plane, {}};
    contour.closed = to - from > 6.28;
    const int last = contour.closed ? points : points - 1;
    for (int n = 0; n < points; ++n) {
        const double angle = from + (to - from) * n / last;
        contour.points.push_back(plane.from_uv(radius * std::cos(angle), radius * std::sin(angle)));
    }
    return contour;
}

double dice(const Mask& a, const Mask& b) {
    double both = 0, sum = 0;
    for (std::size_t n = 0; n < a.values.size(); ++n) {
        both += a.values[n] && b.values[n];
        sum += a.values[n] + b.values[n];
    }
    return 2 * both / sum;
}

Corrections drawn(std::vector<Contour> contours) {
    Corrections corrections;
    corrections.drawing.contours = std::move(contours);
    return corrections;
}

const Plane kAxial = make_plane({0, 0, 0}, {0, 0, 1});
const Plane kOblique = make_plane({0, 0, 0}, {1, 1, 1});

/// A ball of radius 15 with a dent, and the ball.
struct Dented {
    Mask right = test::mask_of(grid_of({1, 1, 1}, 25), ball({}, 15));
    Mask mask = test::mask_of(right.grid, [](const Vec3& p) { return norm(p) < 15 && distance(p, {17, 0, 0}) > 8; });
};

TEST(CorrectMask, WithoutCorrectionsNothingChanges) {
    const Dented dented;
    EXPECT_EQ(correct(dented.mask, {}).mask.values, dented.mask.values);
}

TEST(CorrectMask, CorrectionsThatRepeatTheMaskChangeNothing) {
    for (const double shear : {0.0, 0.3}) {
        const Mask mask = test::mask_of(grid_of({1, 1, 2.5}, 25, shear), ball({0.3, 0.2, 0.1}, 14));
        const std::vector<Plane> planes{make_plane(mask.grid.center_mm(0, 0, 10), {0, 0, 1}), kOblique};
        Corrections corrections;
        corrections.confirmed = planes;
        const CorrectedMask corrected = correct(mask, corrections);
        EXPECT_EQ(corrected.mask.values, mask.values);
        EXPECT_EQ(corrected.report.planes.front().kind, CorrectionKind::confirmed);
        EXPECT_EQ(sentence(corrected.report), "nothing changed: the corrections repeat the mask");
    }
}

TEST(CorrectMask, OutlinesTracedFromTheMaskChangeNothing) {
    std::size_t drawn_planes = 0;
    for (const Vec3& spacing : {Vec3{1, 1, 1}, Vec3{0.9, 0.9, 2.5}}) {
        const Mask mask = test::mask_of(grid_of(spacing, 25), [](const Vec3& p) {
            return norm(p) < 15 && distance(p, {17, 0, 0}) > 8 && !(p.y > 4 && p.z > 3);
        });
        std::vector<Plane> planes;
        for (std::int64_t k = 0; k < mask.grid.size.k; k += 3)
            planes.push_back(make_plane(mask.grid.center_mm(0, 0, k), {0, 0, 1}));
        for (const double offset : {-8.0, -3.0, 2.0, 9.0}) planes.push_back(make_plane({0, offset, 0}, {0.2, 1, 0.4}));
        for (const Plane& plane : planes) {
            Corrections corrections;
            corrections.drawing = trace(mask, std::vector{plane});
            if (corrections.drawing.contours.empty()) continue;
            ++drawn_planes;
            EXPECT_EQ(correct(mask, corrections).mask.values, mask.values)
                << spacing.z << " mm, through " << plane.origin.y << ", " << plane.origin.z;
        }
    }
    EXPECT_GT(drawn_planes, 20U);
}

TEST(CorrectMask, APartOfTheGridGivesTheSameVoxels) {
    const Dented dented;
    const Mask whole = dented.mask;
    const IndexBox box{{7, 5, 9}, {whole.grid.size.i - 3, whole.grid.size.j - 4, whole.grid.size.k - 2}};
    Mask part{grid_of(whole.grid, box), {}};
    const auto of_part = [&](const Mask& mask) {
        std::vector<std::uint8_t> values;
        for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
            for (std::int64_t j = box.low.j; j <= box.high.j; ++j)
                for (std::int64_t i = box.low.i; i <= box.high.i; ++i)
                    values.push_back(mask.values[mask.grid.offset(i, j, k)]);
        return values;
    };
    part.values = of_part(whole);
    const Corrections corrections = drawn({circle(kOblique, 16)});
    const CorrectedMask corrected = correct(whole, corrections, {.reach = 2});
    EXPECT_NE(corrected.mask.values, whole.values);
    EXPECT_EQ(correct(part, corrections, {.reach = 2}).mask.values, of_part(corrected.mask));
}

TEST(CorrectMask, OneOutlineMendsADent) {
    const Dented dented;
    const double before = dice(dented.mask, dented.right);
    for (const Plane& plane : {kAxial, make_plane({0, 0, 0}, {0, 1, 1}), make_plane({0, 0, 0}, {0, 1, 0})}) {
        const CorrectedMask corrected = correct(dented.mask, drawn({circle(plane, 15)}));
        EXPECT_GT(dice(corrected.mask, dented.right), 1 - 0.7 * (1 - before));
        EXPECT_TRUE(corrected.report.warnings.empty());
    }
}

TEST(CorrectMask, ADrawnSliceIsAsDrawn) {
    const Dented dented;
    const CorrectedMask corrected = correct(dented.mask, drawn({circle(kAxial, 15)}));
    const Grid& grid = dented.mask.grid;
    for (std::int64_t j = 0; j < grid.size.j; ++j)
        for (std::int64_t i = 0; i < grid.size.i; ++i)
            EXPECT_EQ(corrected.mask.values[grid.offset(i, j, 25)], dented.right.values[grid.offset(i, j, 25)]);
    EXPECT_GT(corrected.report.added_drawn, 50);
    EXPECT_GT(corrected.report.added_carried, corrected.report.added_drawn);
}

TEST(CorrectMask, AMaskOfOneSliceIsAsDrawn) {
    const Grid grid = grid_of({1, 1, 1}, 20);
    const auto disc = [&](double radius) {
        return test::mask_of(grid, [=](const Vec3& p) { return std::abs(p.z) < 0.5 && std::hypot(p.x, p.y) < radius; });
    };
    const CorrectedMask corrected = correct(disc(12), drawn({circle(kAxial, 9.3)}));
    EXPECT_GT(dice(corrected.mask, disc(9.3)), 0.995);
    EXPECT_TRUE(corrected.report.warnings.empty());
}

TEST(CorrectMask, AnObliquePlaneIsAsDrawnToAVoxel) {
    const Dented dented;
    const CorrectedMask corrected = correct(dented.mask, drawn({circle(kOblique, 15)}));
    std::size_t wrong = 0, all = 0;
    const Grid& grid = dented.mask.grid;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Vec3 p = grid.center_mm(i, j, k);
                if (std::abs(kOblique.distance_to(p)) > 0.5 || std::abs(norm(p) - 15) < 0.7) continue;
                all += norm(p) < 15;
                wrong += corrected.mask.values[grid.offset(i, j, k)] != (norm(p) < 15);
            }
    EXPECT_GT(all, 300U);
    EXPECT_EQ(wrong, 0U);
}

TEST(CorrectMask, NothingChangesBeyondTheReach) {
    // A rod along x with a dent at x = 15.
    const Mask mask = test::mask_of(grid_of({1, 1, 1}, 35), [](const Vec3& p) {
        return std::hypot(p.y, p.z) < 7 && std::abs(p.x) < 30 && distance(p, {15, 0, 8}) > 5;
    });
    const CorrectedMask corrected = correct(mask, drawn({circle(make_plane({15, 0, 0}, {1, 0, 0}), 7)}));
    const Grid& grid = mask.grid;
    ASSERT_LT(corrected.report.reach_mm, 14);
    EXPECT_GT(corrected.report.added_carried, 50);
    for (std::size_t n = 0; n < mask.values.size(); ++n) {
        const double x = grid.center_mm(static_cast<std::int64_t>(n) % grid.size.i, 0, 0).x;
        if (std::abs(x - 15) > corrected.report.reach_mm) {
            ASSERT_EQ(corrected.mask.values[n], mask.values[n]) << x;
        }
    }
}

TEST(CorrectMask, AStrokeReplacesAPieceOfTheOutline) {
    const Dented dented;
    const CorrectedMask corrected = correct(dented.mask, drawn({circle(kAxial, 15, -0.7, 0.7, 40)}));
    EXPECT_GT(dice(corrected.mask, dented.right), 1 - 0.7 * (1 - dice(dented.mask, dented.right)));
    EXPECT_EQ(corrected.report.planes.front().kind, CorrectionKind::piece);
    EXPECT_TRUE(corrected.mask.values[dented.mask.grid.offset(38, 25, 25)]);  // x = 13, in the dent
}

TEST(CorrectMask, AStrokeTakesTheShorterWayRoundWhicheverWayItIsDrawn) {
    const Dented dented;
    Contour stroke = circle(kAxial, 15, -0.7, 0.7, 40);
    const Mask one = correct(dented.mask, drawn({stroke})).mask;
    std::reverse(stroke.points.begin(), stroke.points.end());
    EXPECT_GT(dice(correct(dented.mask, drawn({stroke})).mask, one), 0.9999);
}

TEST(CorrectMask, AStrokeMayTakeAway) {
    const Mask right = test::mask_of(grid_of({1, 1, 1}, 25), ball({}, 15));
    const Mask mask = test::mask_of(right.grid, [](const Vec3& p) { return norm(p) < 15 || distance(p, {14, 0, 0}) < 8; });
    const CorrectedMask corrected = correct(mask, drawn({circle(kAxial, 15, -0.7, 0.7, 40)}));
    EXPECT_GT(dice(corrected.mask, right), 1 - 0.7 * (1 - dice(mask, right)));
    EXPECT_LT(corrected.report.volume_ml, corrected.report.volume_before_ml);
}

TEST(CorrectMask, AStrokeInAnotherPlaneDoesNotBringBackWhatOneTookAway) {
    const auto is_leak = [](const Vec3& p) { return p.x > 20 && p.x < 60 && std::abs(p.y) < 8 && std::abs(p.z) < 8; };
    const Grid grid = grid_of({2, 2, 2}, 70);
    const Mask mask = test::mask_of(grid, [&](const Vec3& p) { return is_leak(p) || (norm(p) < 36 && p.z < 24); });
    const auto leaking = [&](const Mask& one) {
        std::int64_t count = 0;
        std::size_t n = 0;
        for (std::int64_t k = 0; k < grid.size.k; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                for (std::int64_t i = 0; i < grid.size.i; ++i)
                    count += one.values[n++] && norm(grid.center_mm(i, j, k)) > 40 && grid.center_mm(i, j, k).x > 0;
        return count;
    };
    const double radius = std::sqrt(36 * 36 - 1), angle = 0.5;
    const Contour taken = circle({{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, radius, -angle, angle, 40);
    const Plane coronal{{0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
    const Contour added = circle(coronal, radius, 1.17 * std::numbers::pi, 1.83 * std::numbers::pi, 60);
    const std::int64_t whole = leaking(mask), first = leaking(correct(mask, drawn({taken})).mask);
    const CorrectedMask both = correct(mask, drawn({taken, added}));
    EXPECT_LT(first, whole / 10);
    EXPECT_LE(leaking(both.mask), first);
    EXPECT_GT(both.report.added_carried, 0);
}

TEST(CorrectMask, TakingALeakAwayAddsNothingAndLeavesTheRest) {
    const auto is_leak = [](const Vec3& p) { return norm(p - Vec3{36, 0, 0}) < 12; };
    const Mask mask = test::mask_of(grid_of({1, 1, 2}, 50), [&](const Vec3& p) { return is_leak(p) || norm(p) < 36; });
    const Plane coronal{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
    const CorrectReport one = correct(mask, drawn({circle(kAxial, 36)})).report;
    const CorrectReport both = correct(mask, drawn({circle(kAxial, 36), circle(coronal, 36)})).report;
    const double voxels = both.volume_before_ml * 1000 / mask.grid.voxel_volume_mm3();
    EXPECT_LT(one.added_carried, 0.0004 * voxels);
    EXPECT_LT(both.added_carried, 0.001 * voxels);
    EXPECT_LT(both.removed_carried, one.removed_carried);
}

TEST(CorrectMask, AnEmptyPlaneTakesTheObjectAwayThere) {
    const Mask mask = test::mask_of(grid_of({1, 1, 1}, 25), ball({}, 15));
    Corrections corrections;
    corrections.drawing.empty_planes = {make_plane({0, 0, 12}, {0, 0, 1})};
    const CorrectedMask corrected = correct(mask, corrections);
    for (std::int64_t j = 0; j < mask.grid.size.j; ++j)
        for (std::int64_t i = 0; i < mask.grid.size.i; ++i) EXPECT_FALSE(corrected.mask.values[mask.grid.offset(i, j, 37)]);
    EXPECT_GT(corrected.report.volume_ml, 0.7 * corrected.report.volume_before_ml);
}

TEST(CorrectMask, PointsTakeInAndLeaveOut) {
    const Dented dented;
    Corrections corrections;
    corrections.drawing.interior = {{12, 0, 0}};
    corrections.drawing.exterior = {{-12, 0, 0}};
    const CorrectedMask corrected = correct(dented.mask, corrections);
    EXPECT_TRUE(corrected.mask.values[dented.mask.grid.offset(37, 25, 25)]);
    EXPECT_FALSE(corrected.mask.values[dented.mask.grid.offset(13, 25, 25)]);
}

TEST(CorrectMask, ASliceBeyondTheEndAddsNoOtherBehindIt) {
    const Grid grid = grid_of({1, 1, 2.5}, 25);
    const Mask mask = test::mask_of(grid, [](const Vec3& p) { return std::hypot(p.x, p.y) < 9 && std::abs(p.z) < 9; });
    std::int64_t last = 0;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        if (mask.values[grid.offset(25, 25, k)]) last = k;
    const Plane next = make_plane(grid.center_mm(0, 0, last + 1), {0, 0, 1});
    Plane around = next;
    around.origin = {0, 0, next.origin.z};
    const CorrectedMask corrected = correct(mask, drawn({circle(around, 8)}));
    std::size_t there = 0, behind = 0;
    for (std::int64_t j = 0; j < grid.size.j; ++j)
        for (std::int64_t i = 0; i < grid.size.i; ++i) {
            there += corrected.mask.values[grid.offset(i, j, last + 1)];
            behind += corrected.mask.values[grid.offset(i, j, last + 2)];
        }
    EXPECT_NEAR(static_cast<double>(there), std::numbers::pi * 64, 12);
    EXPECT_EQ(behind, 0U);
}

TEST(CorrectMask, ALoosePieceIsNamedAndDroppedWhereAsked) {
    // Two balls on a rod; the rod is cut.
    const Mask mask = test::mask_of(grid_of({1, 1, 1}, 25), [](const Vec3& p) {
        return distance(p, {-12, 0, 0}) < 9 || distance(p, {14, 0, 0}) < 6 ||
               (std::hypot(p.y, p.z) < 2 && std::abs(p.x) < 14);
    });
    Corrections corrections;
    corrections.drawing.empty_planes = {make_plane({3, 0, 0}, {1, 0, 0})};
    const CorrectedMask kept = correct(mask, corrections);
    ASSERT_EQ(kept.report.loose_pieces.size(), 1U);
    EXPECT_GT(kept.report.loose_pieces[0].position.x, 3);
    EXPECT_EQ(component_sizes(kept.mask).size(), 2U);
    CorrectOptions options;
    options.drop_loose = true;
    const CorrectedMask dropped = correct(mask, corrections, options);
    EXPECT_TRUE(dropped.report.dropped_loose);
    EXPECT_EQ(component_sizes(dropped.mask).size(), 1U);
}

TEST(CorrectMask, AMovedLineMovesLittle) {
    const Dented dented;
    const auto size = static_cast<double>(correct(dented.mask, {}).report.volume_ml * 1000);
    Mask before = correct(dented.mask, drawn({circle(kAxial, 15)})).mask;
    for (int n = 1; n <= 8; ++n) {
        const Mask after = correct(dented.mask, drawn({circle(kAxial, 15 + 0.1 * n)})).mask;
        double changed = 0;
        for (std::size_t v = 0; v < after.values.size(); ++v) changed += after.values[v] != before.values[v];
        EXPECT_LT(changed, 0.015 * size) << n;
        before = after;
    }
}

TEST(CorrectMask, AnyNumberOfThreadsGivesTheSameBytes) {
    const Dented dented;
    Work one, three;
    one.threads = 1;
    three.threads = 3;
    EXPECT_EQ(correct(dented.mask, drawn({circle(kOblique, 15)}), {}, one).origin,
              correct(dented.mask, drawn({circle(kOblique, 15)}), {}, three).origin);
}

TEST(CorrectMask, OriginSaysWhatBecameOfEachVoxel) {
    const Dented dented;
    const CorrectedMask corrected = correct(dented.mask, drawn({circle(kAxial, 15)}));
    for (std::size_t n = 0; n < corrected.origin.size(); ++n) {
        const auto made = static_cast<CorrectedVoxel>(corrected.origin[n]);
        const bool was = made == CorrectedVoxel::inside || made == CorrectedVoxel::removed_drawn ||
                         made == CorrectedVoxel::removed_carried;
        const bool is =
            made == CorrectedVoxel::inside || made == CorrectedVoxel::added_drawn || made == CorrectedVoxel::added_carried;
        EXPECT_EQ(was, dented.mask.values[n] != 0);
        EXPECT_EQ(is, corrected.mask.values[n] != 0);
    }
}

TEST(CorrectMask, ContradictionsAreNamed) {
    const Dented dented;
    const auto report =
        correct(dented.mask, drawn({circle(kAxial, 15), circle(make_plane({0, 0, 0}, {0, 1, 0}), 11)})).report;
    ASSERT_FALSE(report.warnings.empty());
    EXPECT_NE(report.warnings[0].find("both yield"), std::string::npos);
}

TEST(CorrectMask, APartThatAnOutlineLeavesOutIsNamed) {
    const Mask mask = test::mask_of(grid_of({1, 1, 1}, 25), [](const Vec3& p) {
        return distance(p, {-10, 0, 0}) < 8 || distance(p, {12, 0, 0}) < 6;
    });
    Plane plane = kAxial;
    plane.origin = {-10, 0, 0};
    const auto report = correct(mask, drawn({circle(plane, 9)})).report;
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_NE(report.warnings[0].find("leaves out a part of 1"), std::string::npos) << report.warnings[0];
}

TEST(CorrectMask, WhatCannotBeUnderstoodIsRefused) {
    const Dented dented;
    const auto refusal = [&](const Mask& mask, const Corrections& corrections, const CorrectOptions& options = {}) {
        try {
            correct(mask, corrections, options);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    Mask empty = dented.mask;
    std::fill(empty.values.begin(), empty.values.end(), 0);
    EXPECT_NE(refusal(empty, {}).find("no voxel inside"), std::string::npos);
    EXPECT_NE(refusal(dented.mask, {}, {.reach = 9}).find("0.25 and 4"), std::string::npos);
    Contour far = circle(make_plane({0, 0, 22}, {0, 0, 1}), 15, -0.7, 0.7, 40);
    EXPECT_NE(refusal(dented.mask, drawn({far})).find("has no outline in its plane"), std::string::npos);
    Contour away = circle(kAxial, 40, -0.1, 0.1, 10);
    EXPECT_NE(refusal(dented.mask, drawn({away})).find("mm from the mask's outline"), std::string::npos);
}

}  // namespace
}  // namespace kontur
