// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/function/fast_function.h"

namespace kontur {

/// What track_surface finds, from about a quarter of the function values. The surface is followed first on a coarse lattice
/// (about every fourth voxel, more or fewer along axes with another spacing); in the coarse cells that it passes, values are
/// interpolated by cubics and computed where that leaves the sign in doubt. How large a value may be and still be in doubt
/// follows from the interpolation's errors where f is known: at the starts, where it is 0, and at every value computed. Then
/// the surface is tracked on the full lattice as track_surface does; values that are still missing are computed. So no sheet
/// or bubble away from the starts is found, no component that a start touches is lost, and masks differ from track_surface's
/// in single voxels within a fraction of a percent of a voxel of the surface. Objects of few voxels are left to
/// track_surface.
SurfaceLattice track_surface_adaptively(const ImplicitFunction& function, const Grid& grid, std::span<const Vec3> starts,
                                        const Work& work = {});

/// Whether values whose sign interpolation leaves in doubt are computed, which is half of the cost. Without, masks differ in
/// voxels within a few percent of the coarse spacing of the surface.
enum class Doubts { resolved, left };

/// The same with a function of the caller's, which keeps what evaluating it has prepared.
SurfaceLattice track_surface_adaptively(FastFunction& function, const Grid& grid, std::span<const Vec3> starts,
                                        const Work& work = {}, Doubts doubts = Doubts::resolved);

/// About how many of the grid's voxels a surface through the starts passes, as if it were an ellipsoid that fills their box
/// as far as that lies in the grid; more where the starts show that there are many objects.
std::int64_t expected_surface_voxels(const Grid& grid, std::span<const Vec3> starts);

}  // namespace kontur
