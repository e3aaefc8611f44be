// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <set>

#include "kontur/extract/voxelize.h"
#include "kontur/fit/fit.h"
#include "kontur/measure/components.h"
#include "kontur/phantom/cases.h"
#include "support/expect_error.h"
#include "support/functions.h"
#include "support/random.h"

namespace kontur {
namespace {

/// f at every voxel centre; outside beyond the grid.
class Samples {
public:
    Samples(const ImplicitFunction& function, const Grid& grid) : grid_(grid) {
        std::vector<Vec3> points;
        for (std::int64_t k = 0; k < grid.size.k; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                for (std::int64_t i = 0; i < grid.size.i; ++i) points.push_back(grid.center_mm(i, j, k));
        values_.resize(points.size());
        function.values(points, values_);
    }

    bool in_grid(const Index3& p) const {
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] < 0 || p[axis] >= grid_.size[axis]) return false;
        return true;
    }
    double value(const Index3& p) const { return values_[grid_.offset(p.i, p.j, p.k)]; }
    bool is_inside(const Index3& p) const { return in_grid(p) && value(p) > 0; }
    /// How many of the points of the box between two corners are inside.
    int inside_count(const Index3& low, const Index3& high) const {
        int count = 0;
        for (std::int64_t k = low.k; k <= high.k; ++k)
            for (std::int64_t j = low.j; j <= high.j; ++j)
                for (std::int64_t i = low.i; i <= high.i; ++i) count += is_inside({i, j, k});
        return count;
    }
    bool is_mixed_cell(const Index3& c) const {
        const int count = inside_count(c, {c.i + 1, c.j + 1, c.k + 1});
        return count != 0 && count != 8;
    }

private:
    Grid grid_;
    std::vector<double> values_;
};

using Cell = std::array<std::int64_t, 3>;  ///< k, j, i: sorts in memory order

/// The cells that can be reached from those around the starts through faces with corners of both signs.
std::set<Cell> flooded_cells(const Samples& samples, const Grid& grid, const std::vector<Vec3>& starts) {
    std::set<Cell> found;
    std::deque<Index3> open;
    const auto visit = [&](const Index3& c) {
        for (int axis = 0; axis < 3; ++axis)
            if (c[axis] < -1 || c[axis] >= grid.size[axis]) return;
        if (samples.is_mixed_cell(c) && found.insert({c.k, c.j, c.i}).second) open.push_back(c);
    };
    const Affine3 to_index = grid.index_to_mm.inverse();
    for (const Vec3& start : starts) {
        const Vec3 at = to_index.apply(start);
        for (int n = 0; n < 27; ++n)
            visit({static_cast<std::int64_t>(std::floor(at.x)) + n % 3 - 1,
                   static_cast<std::int64_t>(std::floor(at.y)) + n / 3 % 3 - 1,
                   static_cast<std::int64_t>(std::floor(at.z)) + n / 9 - 1});
    }
    while (!open.empty()) {
        const Index3 c = open.front();
        open.pop_front();
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) {
                Index3 low = c, high{c.i + 1, c.j + 1, c.k + 1}, next = c;
                (side ? low : high)[axis] = c[axis] + side;
                next[axis] += side ? 1 : -1;
                const int count = samples.inside_count(low, high);
                if (count != 0 && count != 4) visit(next);
            }
    }
    return found;
}

/// Which voxels a surface of these cells encloses: a walk over all lattice edges from the outside, which changes sides at
/// the edges cut within such cells.
std::vector<std::uint8_t> enclosed(const Samples& samples, const Grid& grid, const std::set<Cell>& cells) {
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(grid.voxel_count()), 2);
    std::deque<std::pair<Index3, std::uint8_t>> open;
    const auto cut = [&](const Index3& p, const Index3& q) {
        return samples.is_inside(p) != samples.is_inside(q) &&
               cells.contains({std::min(p.k, q.k), std::min(p.j, q.j), std::min(p.i, q.i)});
    };
    const auto visit = [&](const Index3& from, std::uint8_t side, const Index3& to) {
        if (!samples.in_grid(to)) return;
        const std::uint8_t there = side ^ static_cast<std::uint8_t>(cut(from, to));
        std::uint8_t& known = mask[grid.offset(to.i, to.j, to.k)];
        if (known == 2) {
            known = there;
            open.emplace_back(to, there);
        }
        EXPECT_EQ(known, there) << "the surface does not separate two sides";
    };
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j) {
            visit({-1, j, k}, 0, {0, j, k});
            visit({grid.size.i, j, k}, 0, {grid.size.i - 1, j, k});
        }
    while (!open.empty()) {
        const auto [p, side] = open.front();
        open.pop_front();
        for (int axis = 0; axis < 3; ++axis)
            for (const int step : {-1, 1}) {
                Index3 next = p;
                next[axis] += step;
                visit(p, side, next);
            }
    }
    return mask;
}

std::set<Cell> as_set(const std::vector<Index3>& cells) {
    std::set<Cell> result;
    for (const Index3& c : cells) result.insert({c.k, c.j, c.i});
    return result;
}

/// Tracks and samples everywhere, and compares both with brute force. Returns the tracked mask.
Mask expect_right(const ImplicitFunction& function, const Grid& grid, const std::vector<Vec3>& starts) {
    const Samples samples(function, grid);
    const SurfaceLattice tracked = track_surface(function, grid, starts, {.threads = 2});
    const std::set<Cell> cells = flooded_cells(samples, grid, starts);
    EXPECT_EQ(as_set(tracked.cells), cells);
    EXPECT_EQ(tracked.cells.size(), cells.size()) << "a cell twice";
    const Mask mask = fill(tracked, {.threads = 2});
    EXPECT_TRUE(mask.values == enclosed(samples, grid, cells));

    const SurfaceLattice everywhere = sample_everywhere(function, grid, {.threads = 2});
    const Mask all = fill(everywhere, {.threads = 3});
    EXPECT_EQ(everywhere.evaluations, grid.voxel_count());
    std::int64_t known = 0;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Index3 p{i, j, k};
                EXPECT_EQ(everywhere.lattice.value(p), samples.value(p));
                EXPECT_EQ(all.values[grid.offset(i, j, k)], samples.value(p) > 0);
                if (std::isnan(tracked.lattice.value(p))) continue;
                ++known;
                EXPECT_EQ(tracked.lattice.value(p), samples.value(p));
            }
    EXPECT_EQ(tracked.evaluations, known) << "values computed more than once";
    for (const int threads : {1, 3, 8}) {
        const SurfaceLattice again = track_surface(function, grid, starts, {.threads = threads});
        EXPECT_EQ(again.cells, tracked.cells);
        EXPECT_EQ(again.evaluations, tracked.evaluations);
    }
    return mask;
}

std::int64_t inside_count(const Mask& mask) { return std::count(mask.values.begin(), mask.values.end(), 1); }

TEST(Track, FollowsWhatTouchesTheStartsOnEveryKindOfGrid) {
    const Vec3 center{20, -30, 100};
    const Grid plain = test::grid_about(center, {25, 22, 19}, 1);
    for (const Affine3& change : {Affine3{}, test::kOblique, test::kSheared, test::kMirrored}) {
        const Grid grid = test::changed(plain, change);
        const Mask ball = expect_right(test::ball_function(center, 6.3), grid, {center + Vec3{6.3, 0, 0}});
        EXPECT_NEAR(static_cast<double>(inside_count(ball)) * grid.voxel_volume_mm3(), 4.0 / 3 * M_PI * std::pow(6.3, 3),
                    60);
        expect_right(test::spheroid_function(center, {3, 2, 1}, 5.5), grid, {center + 5.5 / std::sqrt(14) * Vec3{3, 2, 1}});
    }
}

TEST(Track, FindsTheTorusFromOnePoint) {
    const ImplicitFunction torus = test::function_through(test::torus({}, 8, 3, 20));
    const Mask mask = expect_right(torus, test::grid_about({}, {27, 27, 12}, 1), {{11, 0, 0}});
    EXPECT_EQ(component_sizes(mask).size(), 1u);
    EXPECT_EQ(mask.values[mask.grid.offset(13, 13, 6)], 0) << "the hole is filled";
}

TEST(Track, SeparateObjectsNeedAStartEach) {
    TriangleMesh both = test::ball({-8, 0, 0}, 4, 2);
    const TriangleMesh second = test::ball({8, 1, 0}, 5, 2);
    both.points.insert(both.points.end(), second.points.begin(), second.points.end());
    both.normals.insert(both.normals.end(), second.normals.begin(), second.normals.end());
    const ImplicitFunction function = test::function_through(both);
    const Grid grid = test::grid_about({}, {32, 15, 15}, 1);
    const Vec3 on_first{-12, 0, 0}, on_second{13, 1, 0};
    EXPECT_EQ(component_sizes(expect_right(function, grid, {on_first})).size(), 1u);
    EXPECT_EQ(component_sizes(expect_right(function, grid, {on_second})).size(), 1u);
    EXPECT_EQ(component_sizes(expect_right(function, grid, {on_first, on_second})).size(), 2u);
}

TEST(Track, RoughFunctionsOfManySheetsAndBubbles) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> anywhere(-3, 19);
    for (int round = 0; round < 25; ++round) {
        const ImplicitFunction function = test::rough_function(16, random);
        const Grid grid =
            test::changed(test::grid_about({8, 8, 8}, {17, 14, 20}, 1), round % 2 ? test::kSheared : Affine3{});
        std::vector<Vec3> starts;
        for (int i = 0; i < round % 5 + 1; ++i) starts.push_back({anywhere(random), anywhere(random), anywhere(random)});
        expect_right(function, grid, starts);
    }
}

TEST(Track, ObjectCutOffAtTheGridsBorderIsClosedThere) {
    const double radius = 7;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 center{}, start{};
            center[axis] = side * 8;
            start[axis] = side;  // the object's only end inside of the grid
            const Mask mask =
                expect_right(test::ball_function(center, radius), test::grid_about({}, {16, 17, 18}, 1), {start});
            EXPECT_GT(inside_count(mask), 300);
            EXPECT_EQ(component_sizes(mask).size(), 1u);
        }
    const Mask full = expect_right(test::ball_function({}, 40), test::grid_about({}, {9, 8, 7}, 1), {{4, 0, 0}});
    EXPECT_EQ(inside_count(full), 9 * 8 * 7) << "a grid within the object is full";
}

TEST(Track, GridsOfOneVoxelsThickness) {
    const ImplicitFunction ball = test::ball_function({}, 5);
    for (const Index3& size : {Index3{20, 18, 1}, {20, 1, 18}, {1, 20, 18}, {20, 1, 1}, {1, 20, 1}, {1, 1, 20}, {1, 1, 1}}) {
        const Mask mask = expect_right(ball, test::grid_about({}, size, 1), {{5, 0, 0}, {0, 5, 0}, {0, 0, 5}});
        EXPECT_TRUE(inside_count(mask) > 9 || size.i * size.j * size.k == 1);
    }
}

TEST(Track, StartsFarFromTheSurfaceOrTheGridFindNothing) {
    const ImplicitFunction ball = test::ball_function({}, 8);
    const Grid grid = test::grid_about({}, {30, 30, 30}, 1);
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    const Mask mask = expect_right(ball, grid, {{0, 0, 0}, {12, 0, 0}});
    EXPECT_EQ(inside_count(mask), 0) << "inside values around a start are no surface";
    for (const Vec3& start : {Vec3{500, 0, 0}, {0, -1e18, 0}, {nan, 0, 0}, {0, infinity, 0}}) {
        const SurfaceLattice found = track_surface(ball, grid, std::vector<Vec3>{start}, {.threads = 1});
        EXPECT_EQ(found.evaluations, 0);
        EXPECT_TRUE(found.cells.empty());
    }
    EXPECT_TRUE(track_surface(ball, grid, {}, {.threads = 1}).cells.empty());
}

TEST(Track, EvaluatesAboutTheSurfaceOnly) {
    const Grid grid = test::grid_about({}, {100, 100, 100}, 1);
    const SurfaceLattice found =
        track_surface(test::ball_function({}, 40), grid, std::vector<Vec3>{{40, 0, 0}}, {.threads = 0});
    EXPECT_LT(found.evaluations, 6 * M_PI * 40 * 40 * 2.2);
}

TEST(Track, SelfIntersectingContoursOfThePhantomFillAllTheirLobes) {
    const PhantomCase c = phantom_case("self_intersecting");
    Grid grid = c.grid;
    for (int axis = 0; axis < 3; ++axis) {
        grid.index_to_mm.set_column(axis, 2 * grid.index_to_mm.column(axis));
        grid.size[axis] = (grid.size[axis] + 1) / 2;
    }
    const PreparedContours prepared = prepare(c.contours);
    FitOptions options;
    options.normal_offset_mm = 0.3;
    const ImplicitFunction function = fit(prepared, options).function;
    std::vector<Vec3> starts = prepared.crossings;
    for (const Contour& contour : c.contours.contours)
        starts.insert(starts.end(), contour.points.begin(), contour.points.end());
    const Mask mask = expect_right(function, grid, starts);

    // Both lobes of the eight and the ring between the loops, 2 mm inside of their walls, in the middle plane.
    const Affine3 to_index = grid.index_to_mm.inverse();
    const auto is_inside = [&](const Vec3& p) {
        const Vec3 at = to_index.apply(p);
        return mask.values[grid.offset(std::lround(at.x), std::lround(at.y), std::lround(at.z))] != 0;
    };
    EXPECT_TRUE(is_inside({-55 + 30, 0, 0}));
    EXPECT_TRUE(is_inside({-55 - 30, 0, 0}));
    EXPECT_FALSE(is_inside({-55, 20, 0}));
    EXPECT_TRUE(is_inside({35 + 28, 0, 0}));
    EXPECT_FALSE(is_inside({35 + 8, 0, 0})) << "the inner loop is a hole";
}

TEST(Track, StopsWhenAskedTo) {
    StopSource source;
    source.request_stop();
    const Work stopped{.stop = source.token()};
    const Grid grid = test::grid_about({}, {20, 20, 20}, 1);
    const std::vector<Vec3> starts{{5, 0, 0}};
    EXPECT_KONTUR_ERROR(track_surface(test::ball_function({}, 5), grid, starts, stopped), ErrorKind::cancelled, "");
    EXPECT_KONTUR_ERROR(sample_everywhere(test::ball_function({}, 5), grid, stopped), ErrorKind::cancelled, "");
}

}  // namespace
}  // namespace kontur
