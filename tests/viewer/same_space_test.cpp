// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/same_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/expect_error.h"

namespace kontur::viewer {
namespace {

/// Any three axes: anisotropic, oblique, sheared, left-handed.
Grid random_grid(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Grid grid;
    grid.size = {4, 4, 4};
    do
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 column = (1.5 + unit(random)) * normalized(Vec3{unit(random), unit(random), unit(random)});
            grid.index_to_mm.set_column(axis, column);
        }
    while (std::abs(dot(cross(normalized(grid.index_to_mm.column(0)), normalized(grid.index_to_mm.column(1))),
                        normalized(grid.index_to_mm.column(2)))) < 0.2);
    grid.index_to_mm.translation = 7 * Vec3{unit(random), unit(random), unit(random)};
    return grid;
}

/// Points of the box, to its outermost faces.
std::vector<Vec3> lattice(const Grid& grid, int steps) {
    std::vector<Vec3> points;
    const auto at = [&](int n, std::int64_t size) { return -0.5 + static_cast<double>(size) * n / steps; };
    for (int k = 0; k <= steps; ++k)
        for (int j = 0; j <= steps; ++j)
            for (int i = 0; i <= steps; ++i)
                points.push_back(grid.index_to_mm.apply({at(i, grid.size.i), at(j, grid.size.j), at(k, grid.size.k)}));
    return points;
}

bool holds(const Grid& grid, const Vec3& p) {
    const Vec3 at = grid.index_to_mm.inverse().apply(p);
    for (int axis = 0; axis < 3; ++axis)
        if (at[axis] < -0.5 || at[axis] > static_cast<double>(grid.size[axis]) - 0.5) return false;
    return true;
}

TEST(SameSpace, BoxesMeetWhereAPointIsInBothAndElseAreApartByAtLeastTheGap) {
    std::mt19937 random(7);
    int apart = 0, meeting = 0;
    for (int round = 0; round < 300; ++round) {
        const Grid a = random_grid(random), b = random_grid(random);
        const double gap = gap_mm(a, b);
        EXPECT_NEAR(gap, gap_mm(b, a), 1e-9);
        const std::vector<Vec3> in_a = lattice(a, 8);
        const bool share = std::ranges::any_of(in_a, [&](const Vec3& p) { return holds(b, p); });
        if (share) {
            EXPECT_LE(gap, 0) << round;
        }
        if (gap > 0) {
            double nearest = 1e9;
            for (const Vec3& p : in_a)
                for (const Vec3& q : lattice(b, 4)) nearest = std::min(nearest, distance(p, q));
            EXPECT_GE(nearest, gap - 1e-9) << round;
        }
        apart += gap > 0, meeting += share;
    }
    EXPECT_GT(apart, 50);
    EXPECT_GT(meeting, 50);
}

OpenedImage opened(const std::string& title, const std::string& frame, double shift_mm = 0,
                   const std::string& patient = "") {
    Grid grid{{4, 4, 4}, {}};
    grid.index_to_mm.translation = {shift_mm, 0, 0};
    OpenedImage image{
        std::make_shared<const Image>(Image{grid, std::vector<std::int16_t>(64, 0)}), title, {}, {}, frame, {}, {}};
    image.identity.patient_id = patient;
    return image;
}

TEST(SameSpace, OneFrameOfReferenceNeedsNoAssumption) {
    EXPECT_TRUE(assumptions_of_one_space(opened("CT", "1.2.3", 0, "P"), opened("PET", "1.2.3", 2, "P")).empty());
}

TEST(SameSpace, WhatHadToBeAssumedIsSaid) {
    using Sentences = std::vector<std::string>;
    EXPECT_EQ(assumptions_of_one_space(opened("CT", "1.2.3"), opened("pet.nii", "")),
              (Sentences{"pet.nii names no frame of reference: it is taken to lie in the patient space of CT."}));
    EXPECT_EQ(assumptions_of_one_space(opened("ct.nii", ""), opened("PET", "1.2.3")),
              (Sentences{"ct.nii names no frame of reference: it is taken to lie in the patient space of PET."}));
    EXPECT_EQ(
        assumptions_of_one_space(opened("t1.nii", ""), opened("t2.nii", "")),
        (Sentences{"Neither t1.nii nor t2.nii names a frame of reference: both are taken to lie in one patient space."}));
    EXPECT_EQ(assumptions_of_one_space(opened("CT", "1.2.3", 0, "P1"), opened("PET", "1.2.3", 0, "P2")),
              (Sentences{"PET is of the patient with ID P2, CT of the one with ID P1."}));
}

TEST(SameSpace, AnotherFrameOfReferenceAndBoxesThatDoNotMeetAreRefused) {
    EXPECT_KONTUR_ERROR(assumptions_of_one_space(opened("CT", "1.2.3"), opened("PET", "1.2.4")), ErrorKind::invalid_input,
                        "PET has another frame of reference (1.2.4) than CT (1.2.3)");
    EXPECT_KONTUR_ERROR(assumptions_of_one_space(opened("CT", "1.2.3"), opened("PET", "1.2.3", 14.5)),
                        ErrorKind::invalid_input, "PET and CT do not meet: they lie 10 mm apart or more");
}

}  // namespace
}  // namespace kontur::viewer
