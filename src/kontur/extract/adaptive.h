// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/function/fast_function.h"

namespace kontur {

/// What track_surface finds, from about a quarter of the function values. The surface is followed first on a coarse
/// lattice: about every fourth voxel, more or fewer along axes with another spacing. In the coarse cells on the
/// surface, values are interpolated by cubics, and computed where the sign is in doubt. The limit of doubt follows from
/// the interpolation's errors where f is known: at the starts, where it is 0, and at every computed value. Then the
/// surface is tracked on the full lattice as track_surface does, and missing values are computed. So no sheet or bubble
/// away from the starts is found, and no component that a start touches is lost. Masks differ from track_surface's in
/// single voxels within a fraction of a percent of a voxel of the surface. Objects of few voxels are left to
/// track_surface.
SurfaceLattice track_surface_adaptively(const ImplicitFunction& function, const Grid& grid, std::span<const Vec3> starts,
                                        const Work& work = {});

/// Whether values whose sign interpolation leaves in doubt are computed, which is half of the cost. Without, masks differ in
/// voxels within a few percent of the coarse spacing of the surface.
enum class Doubts { resolved, left };

/// The same with a function of the caller's, which keeps what evaluating it has prepared.
SurfaceLattice track_surface_adaptively(FastFunction& function, const Grid& grid, std::span<const Vec3> starts,
                                        const Work& work = {}, Doubts doubts = Doubts::resolved);

/// About how many of the grid's voxels the surface through the starts passes. It is taken as an ellipsoid that fills the
/// part of their box within the grid, or as several where the starts show many objects.
std::int64_t expected_surface_voxels(const Grid& grid, std::span<const Vec3> starts);

}  // namespace kontur
