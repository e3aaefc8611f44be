// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kontur/shape/mesh.h"

namespace kontur::viewer {

/// A surface in few bytes, to be compressed further. Points lie on 65,535 steps along each side of their box. Numbers follow
/// one another as zigzag differences (0, -1, 1, -2, ... as 0, 1, 2, 3, ...).
struct MeshCode {
    Vec3 origin, step_mm;                 ///< a point's place is origin + number * step_mm, along each axis
    std::vector<std::uint8_t> positions;  ///< low bytes of all x, their high bytes, the same of y and z
    std::vector<std::uint8_t> normals;    ///< octahedral (Meyer et al. 2010): all u, then all v; empty without normals
    /// Three numbers for each triangle, each as 7-bit groups, the lowest first, 128 added where more follow: its first point
    /// from the first one of the triangle before, the others from the first one.
    std::vector<std::uint8_t> triangles;
};

MeshCode code_mesh(const TriangleMesh& mesh);

/// Band widths as bytes: steps of a 255th of the largest.
struct WidthCode {
    double step_mm = 0;
    std::vector<std::uint8_t> steps;
};
WidthCode code_widths(std::span<const double> widths_mm);

/// Distances, negative inside, as bytes: 128 is 0, and steps of a 127th of the largest to both sides.
WidthCode code_distances(std::span<const double> distances_mm);

}  // namespace kontur::viewer
