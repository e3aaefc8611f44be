// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/extract/lattice.h"
#include "kontur/function/implicit_function.h"

namespace kontur {

/// The lattice with the values that a search evaluated, and the cells in which the surface was found.
struct SurfaceLattice {
    Lattice lattice;
    std::vector<Index3> cells;     ///< cells with corners inside and outside, in memory order
    std::int64_t evaluations = 0;  ///< function values computed; each lattice point at most once
};

/// Walks over the surface components that pass through the cells of `starts` (mm) or their direct neighbours (paper
/// section 4.2): a cell with corners of both signs leads on through each of its faces with corners of both signs. Every
/// front of cells is evaluated at once, so the work is parallel from the first step; the outcome does not depend on the
/// order. Surface that leaves the grid is followed along the grid's boundary. Starts outside of the grid are ignored.
SurfaceLattice track_surface(const ImplicitFunction& function, const Grid& grid, std::span<const Vec3> starts,
                             const Work& work = {});

/// Evaluates every voxel centre: the oracle, at a cost of voxels x centres.
SurfaceLattice sample_everywhere(const ImplicitFunction& function, const Grid& grid, const Work& work = {});

}  // namespace kontur
