// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "kontur/base/work.h"
#include "kontur/extract/track.h"

namespace kontur {

/// Whether a position, as an index of a grid, is anywhere near what 64 bits hold; false for NaN.
inline bool fits_index(const Vec3& index) {
    return std::abs(index.x) < 1e15 && std::abs(index.y) < 1e15 && std::abs(index.z) < 1e15;
}

/// The cell that contains such a position.
inline Index3 cell_of(const Vec3& index) {
    return {static_cast<std::int64_t>(std::floor(index.x)), static_cast<std::int64_t>(std::floor(index.y)),
            static_cast<std::int64_t>(std::floor(index.z))};
}

/// Fills `values` with a function's values at the points (mm).
using EvaluatePoints = std::function<void(std::span<const Vec3> points_mm, std::span<double> values)>;

/// track_surface on a lattice with some values already known; only the others are evaluated and counted.
SurfaceLattice track_surface(Lattice lattice, const EvaluatePoints& evaluate, std::span<const Vec3> starts,
                             const Work& work);

/// Where linear interpolation has the surface cut the edges of its lattice, in mm; not the edges that leave the grid.
std::vector<Vec3> cut_points(const SurfaceLattice& surface);

}  // namespace kontur
