// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kontur {

/// An edge of a cell, numbered 4 * axis + position: it runs along `axis` from corner `from` to corner `to`.
struct CellEdge {
    int axis, from, to;
};
const std::array<CellEdge, 12>& cell_edges();

/// Three of a cell's edges; a triangle has its corners where the surface cuts them.
using CellTriangle = std::array<std::int8_t, 3>;

/// The surface inside a cell for each of the 256 patterns of inside corners (bit n: corner n, displaced by bit 0, 1, 2 of n
/// along i, j, k). Triangles run counter-clockwise seen from outside on a right-handed lattice.
///
/// The patterns are derived, not listed. On each face a segment cuts off every run of inside corners, so an ambiguous face
/// separates them in both of its cells. The segments of the six faces link to loops. A loop is triangulated without a
/// diagonal inside a face. Hence the mesh is a closed manifold for any field (cf. Lorensen & Cline 1987; Newman & Yi
/// 2006).
std::span<const CellTriangle> cell_triangles(unsigned inside_corners);

}  // namespace kontur
