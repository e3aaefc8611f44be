// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// A square lattice of nodes in a plane: node (i, j) has the plane coordinates (u_min_mm + i step_mm, v_min_mm + j step_mm).
struct IsolineLattice {
    Plane plane;
    double u_min_mm = 0, v_min_mm = 0;
    double step_mm = 1;
    std::int64_t columns = 0, rows = 0;  ///< nodes along u and along v

    std::array<double, 2> uv(std::int64_t i, std::int64_t j) const {
        return {u_min_mm + static_cast<double>(i) * step_mm, v_min_mm + static_cast<double>(j) * step_mm};
    }
    std::int64_t node_count() const { return columns * rows; }
};

/// The eight corners of a parallelepiped: bit `axis` of the index is set at the far end along that axis.
using BoxCorners = std::array<Vec3, 8>;
BoxCorners corners(const Box3& box);

/// The lattice, with nodes at multiples of `step_mm` from the plane's origin, that covers the section of the parallelepiped
/// by the plane with at least one node to spare on every side; nullopt when they do not meet. Throws Error(invalid_input)
/// when the step is not > 0 and Error(too_large) above 2^28 nodes.
std::optional<IsolineLattice> lattice_over(const Plane& plane, const BoxCorners& region, double step_mm);

/// One closed line of the zero level.
struct Isoline {
    std::vector<std::array<double, 2>> points;  ///< (u, v) in mm; the inside lies on the left seen against the normal
    double area_mm2 = 0;                        ///< enclosed area, > 0
    bool hole = false;                          ///< it runs around an outside region
};

/// The zero level of a function from its `values` at the lattice's nodes (u fastest), inside where > 0, by marching squares
/// (the 2D case of Lorensen & Cline 1987). Beyond the lattice everything counts as outside, so lines that reach its border
/// are closed half a step beyond it. Two diagonal inside nodes are joined when the bilinear interpolant is > 0 at its saddle
/// (Nielson & Hamann 1991), hence lines never cross. Crossings are interpolated linearly, or, given the function `exact` of
/// (u, v) itself, located on it by bisection. Lines are ordered by their lowest crossing, row by row.
std::vector<Isoline> isolines(const IsolineLattice& lattice, std::span<const double> values,
                              const std::function<double(double u, double v)>& exact = {});

}  // namespace kontur
