// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "kontur/extract/track.h"

namespace kontur {

/// Fills `values` with a function's values at the points (mm).
using EvaluatePoints = std::function<void(std::span<const Vec3> points_mm, std::span<double> values)>;

/// track_surface on a lattice with some values already known; only the others are evaluated and counted.
SurfaceLattice track_surface(Lattice known, const EvaluatePoints& evaluate, std::span<const Vec3> starts,
                             const Progress& progress);

/// Where linear interpolation has the surface cut the edges of its lattice, in mm; not the edges that leave the grid.
std::vector<Vec3> cut_points(const SurfaceLattice& surface);

}  // namespace kontur
