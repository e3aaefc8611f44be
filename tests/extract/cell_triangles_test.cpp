// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/cell_triangles.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace kontur {
namespace {

using Side = std::pair<int, int>;

const CellEdge& edge(int number) { return cell_edges()[static_cast<std::size_t>(number)]; }

std::set<int> mixed_edges(unsigned inside) {
    std::set<int> result;
    for (int e = 0; e < 12; ++e)
        if ((inside >> edge(e).from & 1u) != (inside >> edge(e).to & 1u)) result.insert(e);
    return result;
}

bool in_one_face(int a, int b) {
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1}) {
            int corners = 0;
            for (const int c : {edge(a).from, edge(a).to, edge(b).from, edge(b).to}) corners += (c >> axis & 1) == side;
            if (corners == 4) return true;
        }
    return false;
}

/// The triangles' directed sides, and how often each occurs.
std::map<Side, int> sides(unsigned inside) {
    std::map<Side, int> result;
    for (const CellTriangle& t : cell_triangles(inside))
        for (std::size_t n = 0; n < 3; ++n) ++result[{t[n], t[(n + 1) % 3]}];
    return result;
}

/// Sides that no other triangle of the cell shares: the surface's border on the cell's faces.
std::set<Side> border(unsigned inside) {
    std::set<Side> result;
    const std::map<Side, int> all = sides(inside);
    for (const auto& [side, count] : all)
        if (!all.contains({side.second, side.first})) result.insert(side);
    return result;
}

TEST(CellEdges, JoinTheCornersAlongEachAxisOnce) {
    std::set<Side> seen;
    for (const CellEdge& e : cell_edges()) {
        EXPECT_EQ(e.to - e.from, 1 << e.axis);
        EXPECT_TRUE(seen.insert({e.from, e.to}).second);
    }
}

TEST(CellTriangles, UseEveryCutEdgeAndNoOtherInAllPatterns) {
    for (unsigned inside = 0; inside < 256; ++inside) {
        std::set<int> used;
        for (const CellTriangle& t : cell_triangles(inside)) {
            EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) << inside;
            used.insert(t.begin(), t.end());
        }
        EXPECT_EQ(used, mixed_edges(inside)) << inside;
    }
}

TEST(CellTriangles, RunThroughNoSideTwiceInOneDirectionInAllPatterns) {
    for (unsigned inside = 0; inside < 256; ++inside)
        for (const auto& [side, count] : sides(inside)) EXPECT_EQ(count, 1) << inside;
}

TEST(CellTriangles, BorderLiesInFacesAndClosesInAllPatterns) {
    for (unsigned inside = 0; inside < 256; ++inside) {
        std::map<int, int> balance;
        for (const Side& side : border(inside)) {
            EXPECT_TRUE(in_one_face(side.first, side.second)) << inside;
            ++balance[side.first];
            --balance[side.second];
        }
        for (const auto& [e, difference] : balance) EXPECT_EQ(difference, 0) << inside;
    }
}

TEST(CellTriangles, NoDiagonalLiesInAFaceInAnyPattern) {
    // Such a side would meet the triangles of the next cell a third time.
    for (unsigned inside = 0; inside < 256; ++inside) {
        const std::map<Side, int> all = sides(inside);
        for (const auto& [side, count] : all)
            EXPECT_FALSE(all.contains({side.second, side.first}) && in_one_face(side.first, side.second)) << inside;
    }
}

TEST(CellTriangles, NeighboursMeetInTheSameSegmentsForAllPatternsOfTheirFace) {
    // For each axis: a cell's upper face and the next cell's lower face, with every pattern of the 12 corners.
    for (int axis = 0; axis < 3; ++axis) {
        const int bit = 1 << axis;
        const auto on_face = [&](const std::set<Side>& all, int side) {
            // As corner pairs of the face, counted without the axis.
            std::set<std::pair<Side, Side>> result;
            const auto flat = [&](int e) { return Side{edge(e).from & ~bit, edge(e).to & ~bit}; };
            const auto lies = [&](int e) { return edge(e).axis != axis && (edge(e).from >> axis & 1) == side; };
            for (const Side& s : all)
                if (lies(s.first) && lies(s.second)) result.insert({flat(s.first), flat(s.second)});
            return result;
        };
        for (unsigned lower = 0; lower < 256; ++lower)
            for (unsigned upper = 0; upper < 256; ++upper) {
                bool share = true;
                for (int corner = 0; corner < 8; ++corner)
                    if ((corner & bit) == 0) share &= (lower >> (corner | bit) & 1u) == (upper >> corner & 1u);
                if (!share) continue;
                std::set<std::pair<Side, Side>> reversed;
                for (const auto& [from, to] : on_face(border(upper), 0)) reversed.insert({to, from});
                ASSERT_EQ(on_face(border(lower), 1), reversed) << axis << " " << lower << " " << upper;
            }
    }
}

}  // namespace
}  // namespace kontur
