// SPDX-License-Identifier: Apache-2.0
#include "kontur/fill_labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "kontur/labels/label_boxes.h"
#include "support/expect_error.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

using test::bytes_of_labels;
using test::index_grid;
using test::is_in_ball;
using test::label_map;

const Vec3 kCenter{22, 21, 20};

/// What is left of a label map when only some voxels are painted.
Image sparse_of(const Image& full, const std::function<bool(const Index3&)>& painted) {
    std::size_t n = 0;
    return label_map(full.grid, [&](const Index3& at) {
        const int label = bytes_of_labels(full)[n++];
        return painted(at) ? label : 0;
    });
}

/// Of the slices from the first to the last voxel of `a` along an axis; -1 for all slices.
double dice(const Image& a, const Image& b, int label, int axis = -1) {
    const LabelBox found = label_boxes(a).at(label);
    std::int64_t both = 0, sum = 0;
    for (std::size_t n = 0; n < bytes_of_labels(a).size(); ++n) {
        const auto m = static_cast<std::int64_t>(n);
        const Index3& size = a.grid.size;
        const Index3 at{m % size.i, m / size.i % size.j, m / (size.i * size.j)};
        if (axis >= 0 && (at[axis] < found.box.low[axis] || at[axis] > found.box.high[axis])) continue;
        const bool in_a = bytes_of_labels(a)[n] == label, in_b = bytes_of_labels(b)[n] == label;
        both += in_a && in_b;
        sum += in_a + in_b;
    }
    return 2.0 * static_cast<double>(both) / static_cast<double>(sum);
}

Image ball(const Grid& grid = index_grid({44, 43, 42})) {
    return label_map(grid, [](const Index3& at) { return is_in_ball(at, kCenter, 15.4) ? 3 : 0; });
}

TEST(FillLabels, AfterItsLastPaintedSliceAnObjectEndsWhereTheMapGoesOn) {
    const Image full = ball(index_grid({44, 43, 60}));
    const Filling filled = fill_labels(sparse_of(full, [](const Index3& at) { return at.k == 6 || at.k == 20; }));
    double inside = 0, right = 0;
    for (std::int64_t k = 6; k <= 20; ++k)
        for (std::int64_t n = k * 44 * 43; n < (k + 1) * 44 * 43; ++n) {
            const auto at = static_cast<std::size_t>(n);
            inside += bytes_of_labels(full)[at] == 3;
            right += bytes_of_labels(full)[at] == 3 && bytes_of_labels(filled.labels)[at] == 3;
        }
    EXPECT_GT(right, 0.95 * inside) << "round, not a cone";
}

TEST(FillLabels, ASteepTubeIsWholeThoughItsSlicesDoNotOverlap) {
    const Image full = label_map(index_grid({90, 30, 31}), [](const Index3& at) {
        return std::hypot(double(at.i) - 12 - 2.2 * double(at.k), double(at.j) - 15) < 5 ? 1 : 0;
    });
    const Filling filled = fill_labels(sparse_of(full, [](const Index3& at) { return at.k % 5 == 0; }));
    EXPECT_GT(dice(full, filled.labels, 1, 2), 0.93) << "11 mm from one section of 10 mm to the next";
    const auto voxels = bytes_of_labels(filled.labels);
    for (std::int64_t k = 0; k <= 30; ++k)
        EXPECT_EQ(voxels[filled.labels.grid.offset(12 + std::lround(2.2 * double(k)), 15, k)], 1)
            << "its middle, slice " << k;
}

TEST(FillLabels, WhatLiesInBothSectionsIsFilledHoweverThinAndFarApart) {
    const Image vessel = label_map(index_grid({30, 30, 41}), [](const Index3& at) {
        return at.i >= 13 && at.i < 17 && at.j >= 13 && at.j < 17 ? 1 : 0;
    });
    const Image wall = label_map(index_grid({50, 50, 41}), [](const Index3& at) {
        const double r = std::hypot(double(at.i) - 25, double(at.j) - 25);
        return r >= 14 && r < 20 ? 1 : 0;
    });
    for (const Image* full : {&vessel, &wall}) {
        const Filling filled = fill_labels(sparse_of(*full, [](const Index3& at) { return at.k % 20 == 0; }));
        EXPECT_GT(dice(*full, filled.labels, 1), 0.93);
        std::int64_t missing = 0;
        for (std::size_t n = 0; n < bytes_of_labels(*full).size(); ++n)
            missing += bytes_of_labels(*full)[n] == 1 && bytes_of_labels(filled.labels)[n] == 0;
        EXPECT_EQ(missing, 0);
    }
}

TEST(FillLabels, AThreadOfSingleVoxelsStaysAThread) {
    const auto thread = [](double slope) {
        return label_map(index_grid({40, 20, 61}), [slope](const Index3& at) {
            return at.i == 12 + std::lround(slope * double(at.k)) && at.j == 10 ? 1 : 0;
        });
    };
    for (const double slope : {0.0, 0.1})
        for (const int step : {3, 6}) {
            const Image full = thread(slope);
            const Filling filled = fill_labels(sparse_of(full, [&](const Index3& at) { return at.k % step == 0; }));
            EXPECT_GT(dice(full, filled.labels, 1), 0.8) << "a slope of " << slope << ", each slice of " << step;
            EXPECT_LT(filled.report.labels[0].added_voxels, 70) << "a slope of " << slope << ", each slice of " << step;
        }
}

TEST(FillLabels, ABallComesBackFromSlicesAcrossEachAxis) {
    const Image full = ball();
    for (int axis = 0; axis < 3; ++axis) {
        const Image sparse = sparse_of(full, [&](const Index3& at) { return at[axis] % 5 == 2; });
        const Filling filled = fill_labels(sparse);
        ASSERT_EQ(filled.report.labels.size(), 1U);
        EXPECT_EQ(filled.report.labels[0].slices[static_cast<std::size_t>(axis)], axis == 0 ? 7 : 6);
        EXPECT_GT(dice(filled.labels, full, 3, axis), 0.975) << axis;
        EXPECT_GT(dice(fill_labels(sparse, {.shape_weight = 0}).labels, full, 3, axis), 0.995) << axis;
    }
}

TEST(FillLabels, EndsGoAsFarAsAsked) {
    const Image full = ball();
    const Image sparse = sparse_of(full, [](const Index3& at) { return at.k % 6 == 2; });  // 8, 14, 20, 26, 32
    const auto extent = [&](FillEnds ends) {
        const Filling filled = fill_labels(sparse, {.ends = ends});
        std::pair<std::int64_t, std::int64_t> range{100, -1};
        for (std::size_t n = 0; n < bytes_of_labels(filled.labels).size(); ++n)
            if (bytes_of_labels(filled.labels)[n]) {
                const std::int64_t k = static_cast<std::int64_t>(n) / (44 * 43);
                range = {std::min(range.first, k), std::max(range.second, k)};
            }
        return range;
    };
    EXPECT_EQ(extent(FillEnds::closed), (std::pair<std::int64_t, std::int64_t>{8, 32}));
    const auto half = extent(FillEnds::half), open = extent(FillEnds::open);
    EXPECT_GE(half.first, 5);
    EXPECT_LT(half.first, 8);
    EXPECT_LE(open.first, half.first);
    EXPECT_GE(open.second, half.second);
    EXPECT_GT(dice(fill_labels(sparse, {.ends = FillEnds::open}).labels, full, 3), 0.97);
}

TEST(FillLabels, SingleSlicesOfThreeDirectionsMakeABody) {
    const Image full = ball();
    const Filling filled =
        fill_labels(sparse_of(full, [](const Index3& at) { return at.i == 21 || at.j == 21 || at.k == 21; }));
    EXPECT_EQ(filled.report.labels[0].slices, (std::array<std::int64_t, 3>{1, 1, 1}));
    EXPECT_GT(dice(filled.labels, full, 3), 0.97);
}

/// Two lobes side by side and a hole in one of them.
Image organs(const Grid& grid) {
    return label_map(grid, [](const Index3& at) {
        if (is_in_ball(at, {15, 21, 20}, 5)) return 7;
        if (is_in_ball(at, {15, 21, 20}, 11)) return 1;
        return is_in_ball(at, {29, 21, 20}, 12) ? 2 : 0;
    });
}

TEST(FillLabels, WhatWasPaintedStaysVoxelForVoxelAndPaintedSlicesGetNothingMore) {
    const Image full = organs(index_grid({44, 43, 42}, {1, 1.2, 2.5}));
    for (const std::int64_t step : {2, 3, 4}) {
        const Image sparse = sparse_of(full, [&](const Index3& at) { return at.k % step == 0; });
        const Filling filled = fill_labels(sparse);
        std::size_t n = 0, in_slices = 0;
        for (std::int64_t k = 0; k < 42; ++k)
            for (std::int64_t m = 0; m < 44 * 43; ++m, ++n) {
                const bool changed = bytes_of_labels(filled.labels)[n] != bytes_of_labels(sparse)[n];
                ASSERT_FALSE(changed && bytes_of_labels(sparse)[n]) << k;
                in_slices += k % step == 0 && changed;
            }
        EXPECT_EQ(in_slices, 0U) << step;
        for (const int label : {1, 2, 7})
            EXPECT_GT(dice(filled.labels, full, label, 2), 0.945) << "label " << label << ", every " << step;
    }
}

TEST(FillLabels, TheReportCountsWhatTheMapHolds) {
    const Image sparse = sparse_of(organs(index_grid({44, 43, 42})), [](const Index3& at) { return at.k % 4 == 0; });
    const Filling filled = fill_labels(sparse);
    const auto before = count_labels(sparse), after = count_labels(filled.labels);
    ASSERT_EQ(filled.report.labels.size(), 3U);
    for (const FilledLabel& one : filled.report.labels) {
        EXPECT_EQ(one.painted_voxels, before.at(one.label));
        EXPECT_EQ(one.painted_voxels + one.added_voxels, after.at(one.label));
        EXPECT_GT(one.added_voxels, 0);
    }
}

/// Three sectors of a slanted tube, which meet in its middle.
Image sectors(const Grid& grid) {
    return label_map(grid, [](const Index3& at) {
        const double x = double(at.i) - 22 - 0.35 * (double(at.k) - 20), y = double(at.j) - 21;
        if (std::hypot(x, y) > 15) return 0;
        const double angle = std::atan2(y, x) + 0.03 * double(at.k);
        return 1 + static_cast<int>(std::floor(3 * (angle + 9 * std::numbers::pi) / (2 * std::numbers::pi))) % 3;
    });
}

/// Voxels of `full` that share a face with another label there.
std::vector<std::size_t> shared_borders(const Image& full) {
    const Index3& size = full.grid.size;
    std::vector<std::size_t> found;
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 1; j + 1 < size.j; ++j)
            for (std::int64_t i = 1; i + 1 < size.i; ++i) {
                const std::size_t n = full.grid.offset(i, j, k);
                const int own = bytes_of_labels(full)[n];
                if (own == 0) continue;
                for (const std::size_t m :
                     {n - 1, n + 1, n - static_cast<std::size_t>(size.i), n + static_cast<std::size_t>(size.i)})
                    if (bytes_of_labels(full)[m] != own && bytes_of_labels(full)[m] != 0) {
                        found.push_back(n);
                        break;
                    }
            }
    return found;
}

TEST(FillLabels, TouchingLabelsLeaveNoGapsBetweenThem) {
    const Image full = sectors(index_grid({50, 43, 41}));
    const Image sparse = sparse_of(full, [](const Index3& at) { return at.k % 8 == 0; });
    const auto borders = shared_borders(full);
    const auto count = [&](const Image& filled, const auto& holds) {
        return std::count_if(borders.begin(), borders.end(),
                             [&](std::size_t n) { return holds(bytes_of_labels(filled)[n], bytes_of_labels(full)[n]); });
    };
    const Filling alone = fill_labels(sparse, {.jointly = false}), together = fill_labels(sparse);
    const auto is_gap = [](int label, int) { return label == 0; };
    const auto is_wrong = [](int label, int truth) { return label != truth; };
    EXPECT_GT(count(alone.labels, is_gap), 20);
    EXPECT_LE(10 * count(together.labels, is_gap), 3 * count(alone.labels, is_gap));
    EXPECT_LT(count(together.labels, is_wrong), count(alone.labels, is_wrong));
    EXPECT_GT(together.report.closed_voxels, 0);
    EXPECT_EQ(alone.report.closed_voxels, 0);
    for (const int label : {1, 2, 3}) EXPECT_GT(dice(together.labels, full, label), dice(alone.labels, full, label) - 0.001);
}

TEST(FillLabels, BetweenParallelSlicesTheUnionOfLabelsNeedsNoFit) {
    const Image full = sectors(index_grid({50, 43, 41}));
    const auto steps_of_solvers = [&](const FillOptions& options, const Image& sparse) {
        int steps = 0;
        const Work work{.threads = 1,
                        .callback = [&](std::string_view stage, double) { steps += stage == "solve" ? 1 : 0; }};
        static_cast<void>(fill_labels(sparse, options, work));
        return steps;
    };
    const Image sparse = sparse_of(full, [](const Index3& at) { return at.k % 8 == 0; });
    EXPECT_EQ(steps_of_solvers({}, sparse), steps_of_solvers({.jointly = false}, sparse));
    EXPECT_GT(steps_of_solvers({.ends = FillEnds::half}, sparse),
              steps_of_solvers({.ends = FillEnds::half, .jointly = false}, sparse))
        << "beyond the slices there are no shapes";
}

/// A bent body and a ball in its bend: what encloses both is far from either.
TEST(FillLabels, LabelsThatArePaintedInTurnsAreNotMeltedIntoOne) {
    const Image full = label_map(index_grid({64, 50, 41}), [](const Index3& at) {
        const double x = static_cast<double>(at.i), y = static_cast<double>(at.j), z = static_cast<double>(at.k);
        const double middle = 10 + 24 * std::sin(std::numbers::pi * z / 40);  // of a tube that bows away and comes back
        if (std::hypot(x - middle, y - 25) < 7) return 1;
        return std::hypot(x - 18, y - 25) < 8 ? 2 : 0;
    });
    std::size_t n = 0;
    const Image painted = label_map(full.grid, [&](const Index3& at) {
        const int label = bytes_of_labels(full)[n++];
        const bool is_end = at.k == 0 || at.k == 40;
        return is_end || at.k % 4 == (label == 1 ? 0 : 2) ? label : 0;
    });
    FillOptions options;
    const Filling together = fill_labels(painted, options);
    options.jointly = false;
    const Filling alone = fill_labels(painted, options);
    for (const int label : {1, 2})
        EXPECT_GT(dice(full, together.labels, label), dice(full, alone.labels, label) - 0.005) << label;
}

TEST(FillLabels, OnlyChosenLabelsAreFilled) {
    const Image sparse = sparse_of(organs(index_grid({44, 43, 42})), [](const Index3& at) { return at.k % 4 == 0; });
    const auto before = count_labels(sparse), after = count_labels(fill_labels(sparse, {.labels = {2}}).labels);
    EXPECT_EQ(after.at(1), before.at(1));
    EXPECT_EQ(after.at(7), before.at(7));
    EXPECT_GT(after.at(2), before.at(2));
}

TEST(FillLabels, SameBytesForAnyNumberOfThreads) {
    const Image sparse = sparse_of(organs(index_grid({44, 43, 42})), [](const Index3& at) { return at.k % 3 == 0; });
    const auto once = bytes_of_labels(fill_labels(sparse, {}, {.threads = 1}).labels);
    EXPECT_EQ(bytes_of_labels(fill_labels(sparse, {}, {.threads = 3}).labels), once);
}

/// A column that bends back and forth between its painted slices.
bool is_in_bent_column(const Index3& at) {
    const double k = static_cast<double>(at.k);
    return std::hypot(static_cast<double>(at.i) - 22 - 3 * std::sin(0.55 * k), static_cast<double>(at.j) - 21) <
           10 + 1.5 * std::cos(0.4 * k);
}

TEST(FillLabels, AnImageShowsHowTheSurfaceRunsBetweenTheSlices) {
    const Grid grid = index_grid({44, 43, 57});
    const Image full = label_map(grid, [](const Index3& at) { return is_in_bent_column(at) && at.k > 3 && at.k < 53; });
    const Image picture = label_map(grid, [](const Index3& at) {
        return (is_in_bent_column(at) ? 180 : 60) + (7 * at.i + 13 * at.j + 29 * at.k) % 11;  // no two neighbours alike
    });
    const Image sparse = sparse_of(full, [](const Index3& at) { return at.k % 6 == 4; });
    const Filling without = fill_labels(sparse), with = fill_labels(sparse, &picture);
    EXPECT_EQ(without.report.labels[0].image.verdict, ImageVerdict::none);
    EXPECT_EQ(with.report.labels[0].image.verdict, ImageVerdict::used);
    EXPECT_GT(dice(with.labels, full, 1, 2), dice(without.labels, full, 1, 2) + 0.02);
    std::size_t changed = 0;
    for (std::size_t n = 0; n < bytes_of_labels(sparse).size(); ++n)
        changed += bytes_of_labels(sparse)[n] && !bytes_of_labels(with.labels)[n];
    EXPECT_EQ(changed, 0U);
}

TEST(FillLabels, AnImageThatSaysNothingChangesNextToNothing) {
    const Image sparse = sparse_of(ball(), [](const Index3& at) { return at.k % 4 == 0; });
    const Image empty{sparse.grid, std::vector<float>(static_cast<std::size_t>(sparse.grid.voxel_count()), 7.F)};
    const Filling with = fill_labels(sparse, &empty), without = fill_labels(sparse);
    std::int64_t differing = 0;
    for (std::size_t n = 0; n < bytes_of_labels(sparse).size(); ++n)
        differing += bytes_of_labels(with.labels)[n] != bytes_of_labels(without.labels)[n];
    EXPECT_LT(differing, without.report.labels[0].added_voxels / 200);
}

TEST(FillLabels, AnImageFarAwayIsRefused) {
    const Image sparse = sparse_of(ball(), [](const Index3& at) { return at.k % 4 == 0; });
    Image other{sparse.grid, sparse.samples};
    other.grid.index_to_mm.translation = {0, 500, 0};
    EXPECT_KONTUR_ERROR(fill_labels(sparse, &other), ErrorKind::invalid_input,
                        "the label map and the image lie 457 mm apart");
}

TEST(FillLabels, NothingLeftOutStaysAsItIs) {
    const Image full = organs(index_grid({44, 43, 42}));
    const Filling filled = fill_labels(full);
    EXPECT_EQ(bytes_of_labels(filled.labels), bytes_of_labels(full));
    const Image one = sparse_of(full, [](const Index3& at) { return at.k == 20; });
    const Filling alone = fill_labels(one);
    EXPECT_EQ(bytes_of_labels(alone.labels), bytes_of_labels(one));
    EXPECT_EQ(alone.report.labels[0].warnings.at(0),
              "left as it was painted: that is 1 slice, and at least 2 are needed unless the ends are open");
}

TEST(FillLabels, KeepsTheSampleType) {
    const Grid grid = index_grid({30, 30, 21});
    std::vector<std::int32_t> samples;
    for (std::int64_t k = 0; k < 21; ++k)
        for (std::int64_t m = 0; m < 900; ++m)
            samples.push_back(k % 4 == 0 && is_in_ball({m % 30, m / 30, k}, {14, 15, 10}, 9) ? 100000 : 0);
    const Filling filled = fill_labels({grid, samples});
    const auto& result = std::get<std::vector<std::int32_t>>(filled.labels.samples);
    EXPECT_EQ(std::count(result.begin(), result.end(), 100000),
              filled.report.labels[0].painted_voxels + filled.report.labels[0].added_voxels);
    EXPECT_GT(filled.report.labels[0].added_voxels, 0);
}

TEST(FillLabels, RefusesWhatCannotBeFilled) {
    const Image map = ball();
    EXPECT_KONTUR_ERROR(fill_labels(map, {.labels = {3, 9}}), ErrorKind::invalid_input,
                        "the label 9 is to be filled, but no voxel has it");
    EXPECT_KONTUR_ERROR(fill_labels(map, {.shape_weight = 1.5}), ErrorKind::invalid_input,
                        "shape-based interpolation is 1.5");
    EXPECT_KONTUR_ERROR(fill_labels(map, {.smoothing_voxels = -1}), ErrorKind::invalid_input,
                        "smoothing of the painted outlines");
    EXPECT_KONTUR_ERROR(fill_labels({index_grid({2, 1, 1}), std::vector<float>{0, 0.5F}}), ErrorKind::invalid_input,
                        "no label map");
    EXPECT_KONTUR_ERROR(fill_labels({index_grid({2, 1, 1}), std::vector<std::uint8_t>{0, 0}}), ErrorKind::invalid_input,
                        "nothing is painted");
}

}  // namespace
}  // namespace kontur
