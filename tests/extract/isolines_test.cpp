// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/isolines.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/expect_error.h"

namespace kontur {
namespace {

IsolineLattice unit_lattice(std::int64_t columns, std::int64_t rows) {
    IsolineLattice lattice;
    lattice.columns = columns;
    lattice.rows = rows;
    return lattice;
}

/// Connected regions of the 4 x 4 nodes whose bit in `nodes` is set, padded by a ring of `ring`; `diagonal` neighbours
/// count.
int regions(unsigned nodes, bool ring, bool diagonal) {
    constexpr int n = 6;
    std::array<bool, n * n> open{};
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const bool border = i == 0 || j == 0 || i == n - 1 || j == n - 1;
            open[i + n * j] = border ? ring : (nodes >> (i - 1 + 4 * (j - 1))) & 1;
        }
    int count = 0;
    std::vector<int> stack;
    for (int start = 0; start < n * n; ++start) {
        if (!open[start]) continue;
        ++count;
        for (stack.assign(1, start), open[start] = false; !stack.empty();) {
            const int here = stack.back(), i = here % n, j = here / n;
            stack.pop_back();
            for (int dj = -1; dj <= 1; ++dj)
                for (int di = -1; di <= 1; ++di) {
                    const int x = i + di, y = j + dj;
                    if ((!diagonal && di && dj) || x < 0 || y < 0 || x >= n || y >= n || !open[x + n * y]) continue;
                    open[x + n * y] = false;
                    stack.push_back(x + n * y);
                }
        }
    }
    return count;
}

TEST(Isolines, SeparateTheRegionsOfEveryFourByFourLattice) {
    const IsolineLattice lattice = unit_lattice(4, 4);
    std::vector<double> values(16);
    for (unsigned nodes = 0; nodes < 1u << 16; ++nodes) {
        for (unsigned b = 0; b < 16; ++b) values[b] = nodes >> b & 1 ? 1 : -1;
        const std::vector<Isoline> lines = isolines(lattice, values);
        const auto holes = std::count_if(lines.begin(), lines.end(), [](const Isoline& line) { return line.hole; });
        // Saddles of equal values separate the inside, so the inside is 4-connected and the outside 8-connected.
        ASSERT_EQ(static_cast<int>(lines.size()) - holes, regions(nodes, false, false)) << nodes;
        ASSERT_EQ(holes, regions(~nodes & 0xffff, true, true) - 1) << nodes;
    }
}

TEST(Isolines, JoinASaddleByTheSignOfItsBilinearInterpolant) {
    const IsolineLattice lattice = unit_lattice(2, 2);
    EXPECT_EQ(isolines(lattice, std::vector<double>{3, -1, -1, 3}).size(), 1u);
    EXPECT_EQ(isolines(lattice, std::vector<double>{-1, 3, 3, -1}).size(), 1u);
    EXPECT_EQ(isolines(lattice, std::vector<double>{1, -3, -3, 1}).size(), 2u);
    EXPECT_EQ(isolines(lattice, std::vector<double>{-3, 1, 1, -3}).size(), 2u);
}

TEST(Isolines, CloseHalfAStepBeyondTheLatticesBorder) {
    const std::vector<Isoline> lines = isolines(unit_lattice(5, 3), std::vector<double>(15, 1.0));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_DOUBLE_EQ(lines[0].area_mm2, 5 * 3 - 4 * 0.125) << "corners are cut, as a mesh's are";
    EXPECT_FALSE(lines[0].hole);
}

class RingTest : public testing::TestWithParam<bool> {
protected:
    static double ring(double u, double v) { return 3 - std::abs(std::hypot(u - 1, v + 2) - 10); }
    /// The lattice over the ring, in a plane whose frame is left-handed if the parameter says so.
    static IsolineLattice lattice() {
        Plane plane = make_plane({10, 20, 30}, {1, -2, 0.5});
        if (GetParam()) plane.v = -plane.v;
        IsolineLattice result;
        result.plane = plane;
        result.u_min_mm = -15;
        result.v_min_mm = -18;
        result.step_mm = 0.5;
        result.columns = result.rows = 65;
        return result;
    }
    static std::vector<double> values() {
        std::vector<double> result;
        for (std::int64_t j = 0; j < lattice().rows; ++j)
            for (std::int64_t i = 0; i < lattice().columns; ++i)
                result.push_back(ring(lattice().uv(i, j)[0], lattice().uv(i, j)[1]));
        return result;
    }
};

TEST_P(RingTest, LiesWithTheInsideOnTheLeftSeenAgainstTheNormal) {
    for (const Isoline& line : isolines(lattice(), values())) {
        Vec3 twice_area;
        const Plane plane = lattice().plane;
        for (std::size_t i = 0; i < line.points.size(); ++i) {
            const auto &p = line.points[i], &q = line.points[(i + 1) % line.points.size()];
            twice_area += cross(plane.from_uv(p), plane.from_uv(q));
        }
        const double area = 0.5 * dot(twice_area, plane.normal);
        EXPECT_NEAR(area, line.hole ? -line.area_mm2 : line.area_mm2, 1e-6);
    }
}

TEST_P(RingTest, IsFoundExactlyByBisectionAndCloselyWithoutIt) {
    for (const bool exact : {false, true}) {
        const auto lines = exact ? isolines(lattice(), values(), ring) : isolines(lattice(), values());
        ASSERT_EQ(lines.size(), 2u);
        EXPECT_NE(lines[0].hole, lines[1].hole);
        for (const Isoline& line : lines) {
            const double radius = line.hole ? 7 : 13;
            EXPECT_NEAR(line.area_mm2, std::numbers::pi * radius * radius, 0.005 * line.area_mm2);
            for (const auto& [u, v] : line.points) EXPECT_NEAR(ring(u, v), 0, exact ? 1e-12 : 0.01);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Isolines, RingTest, testing::Bool(),
                         [](const auto& instance) { return instance.param ? "LeftHandedPlane" : "RightHandedPlane"; });

TEST(LatticeOver, CoversTheSectionWithAMarginAndSkipsPlanesThatMiss) {
    const BoxCorners box = corners({{-10, -20, -30}, {10, 20, 30}});
    const auto axial = lattice_over(make_plane({3, 4, 29.5}, {0, 0, 1}), box, 0.7);
    ASSERT_TRUE(axial);
    const auto last = axial->uv(axial->columns - 1, axial->rows - 1);
    for (const Vec3& corner : box) {
        const auto [u, v] = axial->plane.to_uv(corner);
        EXPECT_LE(axial->u_min_mm, u - 0.7 + 1e-9);
        EXPECT_LE(axial->v_min_mm, v - 0.7 + 1e-9);
        EXPECT_GE(last[0], u + 0.7 - 1e-9);
        EXPECT_GE(last[1], v + 0.7 - 1e-9);
    }
    EXPECT_TRUE(lattice_over(make_plane({0, 0, 30}, {0, 0, 1}), box, 1)) << "touches";
    EXPECT_FALSE(lattice_over(make_plane({0, 0, 30.001}, {0, 0, 1}), box, 1));
    EXPECT_FALSE(lattice_over(make_plane({40, 40, 40}, {1, 1, 1}), box, 1));
}

TEST(LatticeOver, RefusesUselessSteps) {
    const BoxCorners box = corners({{0, 0, 0}, {10, 10, 10}});
    for (const double step : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_KONTUR_ERROR(lattice_over({}, box, step), ErrorKind::invalid_input, "step");
    EXPECT_KONTUR_ERROR(lattice_over({}, box, 1e-4), ErrorKind::too_large, "268435456");
    EXPECT_KONTUR_ERROR(lattice_over({}, box, 1e-300), ErrorKind::too_large, "268435456");
}

}  // namespace
}  // namespace kontur
